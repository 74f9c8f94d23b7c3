; A finite number is its significand times a power of two, written in the form of exact-product.
(declare-const a Word)
(define-fun assumed () Bool (is-finite a))
(define-fun claimed () Bool
  (let ((e (bvadd (exponent a) (_ bv$DECODE_FIELD $WE))))
    (= (fp.abs (wide a))
       (fp.sub RNE (fp #b0 e (concat (_ bv0 $DECODE_PAD) (significand a))) (fp #b0 e (_ bv0 $WF))))))
