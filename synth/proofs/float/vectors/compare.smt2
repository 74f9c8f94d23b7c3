; Whether the specification of comparisons agrees with a test vector. `second`: false for == (quiet), true for <=.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (and (= (not (= result (_ bv0 $W)))
          (or (fp.eq (number a) (number b)) (and second (fp.lt (number a) (number b)))))
       (= flags (compare-flags a b second))))
