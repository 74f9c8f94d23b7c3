; Specification of the rows of the radix-4 divider. Residuals w and divisors d have $N bits, two of them integer bits.
; A residual is the signed sum of two words, modulo 4. Sort Exact has four more bits, so that nothing overflows.

(define-sort Residual () (_ BitVec $N))
(define-sort Exact () (_ BitVec $N4))

(define-fun residual ((sum Residual) (carry Residual)) Exact ((_ sign_extend 4) (bvadd sum carry)))
(define-fun unsigned ((x Residual)) Exact ((_ zero_extend 4) x))
(define-fun small ((x (_ BitVec 2))) Exact ((_ zero_extend $N2) x))
(define-fun twice ((x Exact)) Exact (bvadd x x))
(define-fun thrice ((x Exact)) Exact (bvadd x x x))

; 1 <= d < 2
(define-fun is-divisor ((d Residual)) Bool (= ((_ extract $N_TOP $N_NEXT) d) #b01))
; |w| <= 2/3 d
(define-fun is-remainder ((w Exact) (d Residual)) Bool
  (and (bvsle (thrice w) (twice (unsigned d))) (bvsle (bvneg (twice (unsigned d))) (thrice w))))
; k d, for k from -2 to 4
(define-fun times ((k Exact) (d Residual)) Exact
  (ite (= k (_ bv0 $N4)) (_ bv0 $N4)
  (ite (= k (_ bv1 $N4)) (unsigned d)
  (ite (= k (_ bv2 $N4)) (twice (unsigned d))
  (ite (= k (_ bv3 $N4)) (thrice (unsigned d))
  (ite (= k (_ bv4 $N4)) (twice (twice (unsigned d)))
  (ite (= k (bvneg (_ bv1 $N4))) (bvneg (unsigned d))
       (bvneg (twice (unsigned d))))))))))
