; Specification of a * b, in terms of the product of the significands. IEEE 754-2019, clauses 5.4.1 and 7.

(define-sort Product () (_ BitVec $P))

; A finite number is significand / 2^($S - 1) * 2^(exponent - bias). Subnormal numbers have exponent 1.
(define-fun field ((w Word)) (_ BitVec $E) ((_ extract $FIELD_HIGH $F) w))
(define-fun is-normal-field ((w Word)) Bool (not (= (field w) (_ bv0 $E))))
(define-fun significand ((w Word)) (_ BitVec $S)
  (concat (bit (is-normal-field w)) ((_ extract $QUIET 0) w)))
(define-fun exponent ((w Word)) (_ BitVec $WE)
  ((_ zero_extend $EXTEND) (ite (is-normal-field w) (field w) (_ bv1 $E))))

; product-of: the product of the significands. Queries without a multiplication assume only possible-product:
; multiplying by a significand in [1, 2) scales the other one by a factor in [1, 2), and a product is zero only if a
; factor is zero.
(define-fun product-of ((a Word) (b Word)) Product
  (bvmul ((_ zero_extend $S) (significand a)) ((_ zero_extend $S) (significand b))))
(define-fun in-range ((x Word) (y Word) (product Product)) Bool
  (let ((once (bvshl ((_ zero_extend $S) (significand x)) (_ bv$F $P)))
        (twice (bvshl ((_ zero_extend $S) (significand x)) (_ bv$S $P))))
    (=> (is-normal-field y) (and (bvule once product) (or (bvult product twice) (= product once))))))
(define-fun possible-product ((a Word) (b Word) (product Product)) Bool
  (and (in-range a b product) (in-range b a product)
       (= (= product (_ bv0 $P))
          (or (= (significand a) (_ bv0 $S)) (= (significand b) (_ bv0 $S))))))

; The exact product of finite numbers as a Wide. (1 + product / 2^k) * 2^e - 2^e = product * 2^(e - k).
(define-fun product-magnitude ((a Word) (b Word) (product Product)) Wide
  (let ((e (bvadd (exponent a) (exponent b) (_ bv$PRODUCT_FIELD $WE))))
    (fp.sub RNE (fp #b0 e (concat (_ bv0 $PAD) product)) (fp #b0 e (_ bv0 $WF)))))
(define-fun exact-product ((a Word) (b Word) (product Product)) Wide
  (let ((x (product-magnitude a b product)))
    (ite (= (is-negative a) (is-negative b)) x (fp.neg x))))

(define-fun multiply-invalid ((a Word) (b Word)) Bool
  (or (is-signaling a) (is-signaling b)
      (and (fp.isInfinite (number a)) (fp.isZero (number b)))
      (and (fp.isZero (number a)) (fp.isInfinite (number b)))))

(define-fun multiply-result ((m RoundingMode) (a Word) (b Word) (product Product)) Float
  (ite (or (fp.isNaN (number a)) (fp.isNaN (number b)) (multiply-invalid a b)) (_ NaN $E $FS)
  (ite (or (fp.isInfinite (number a)) (fp.isInfinite (number b)))
       (ite (= (is-negative a) (is-negative b)) (_ +oo $E $FS) (_ -oo $E $FS))
       ((_ to_fp $E $FS) m (exact-product a b product)))))

(define-fun multiply-flags ((m RoundingMode) (after Bool) (a Word) (b Word) (product Product))
                           (_ BitVec 5)
  (let ((x (exact-product a b product)))
    (flags
      (multiply-invalid a b)
      false
      (and (is-finite a) (is-finite b))
      m after
      ((_ to_fp $E $FS) RTN x) ((_ to_fp $E $FS) RTP x)
      x x)))
