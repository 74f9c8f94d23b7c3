; Whether the specification agrees with a test vector. `agrees` has the same arguments for all operations. `second` is
; argument `subtract` of add and `signaling` of compare. Only divide uses wide-a and wide-b.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (and (represents result (add-result m a b second)) (= flags (add-flags m after a b second))))
