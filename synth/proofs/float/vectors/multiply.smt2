; Whether the specification of products, and SMT-LIB's fp.mul, agree with a test vector.
(define-fun agrees ((m RoundingMode) (after Bool) (a Word) (b Word) (result Word)
                    (flags (_ BitVec 5)) (second Bool) (wide-a WideWord) (wide-b WideWord)) Bool
  (let ((product (product-of a b)))
    (and (possible-product a b product)
         (represents result (multiply-result m a b product))
         (represents result (fp.mul m (number a) (number b)))
         (= flags (multiply-flags m after a b product)))))
