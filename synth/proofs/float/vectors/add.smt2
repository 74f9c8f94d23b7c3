; Whether the specification says of an operation what a vector says. Those of all operations have the
; same arguments: `subtract` is of add, `signaling` of compare; wide-a and wide-b are of divide.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (and (represents result (add-result m a b second)) (= flags (add-flags m after a b second))))
