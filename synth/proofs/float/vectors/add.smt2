; Whether the specification agrees with a vector. The functions of all operations have the same arguments: `second` is
; `subtract` of add, `signaling` of compare; only divide uses wide-a and wide-b.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (and (represents result (add-result m a b second)) (= flags (add-flags m after a b second))))
