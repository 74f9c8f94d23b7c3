; Two steps of the derivation "Error of t" in hit_test_pkg. z3 must answer "sat" where a question says so (then its
; assumptions are possible), else "unsat". All values are real numbers.

; Claim: |V - exact product| < 48.5 u M, where V is I . N computed in binary32, u = 2^-24 is the unit roundoff, and M =
; 2^(largest exponent of a component of N). |I_i| <= 2. n_i: magnitude of the record's word N_i, whose error is at most
; 1.01 u n_i. x_i = I_i N_i. y_i = I_i times the error of N_i. p_i: x_i, rounded. s: p_1 + p_2, rounded.
(push)
(define-fun u () Real (/ 1.0 16777216.0))
(define-fun within ((x Real) (bound Real)) Bool (and (<= x bound) (<= (- bound) x)))
(declare-const M Real)
(declare-const n1 Real) (declare-const n2 Real) (declare-const n3 Real)
(assert (and (<= 0.0 n1) (< n1 (* 2.0 M)) (<= 0.0 n2) (< n2 (* 2.0 M)) (<= 0.0 n3) (< n3 (* 2.0 M))))
(declare-const x1 Real) (declare-const x2 Real) (declare-const x3 Real)
(declare-const y1 Real) (declare-const y2 Real) (declare-const y3 Real)
(assert (and (within x1 (* 2.0 n1)) (within x2 (* 2.0 n2)) (within x3 (* 2.0 n3))))
(assert (and (within y1 (* 2.02 u n1)) (within y2 (* 2.02 u n2)) (within y3 (* 2.02 u n3))))
(declare-const p1 Real) (declare-const p2 Real) (declare-const p3 Real)
(declare-const s Real) (declare-const V Real)
(define-fun most ((n Real)) Real (+ (* 2.0 n) (* 2.0 u n)))
(define-fun s-most () Real (+ (most n1) (most n2) (* u (most n1)) (* u (most n2))))
(assert (and (within (- p1 x1) (* 2.0 u n1)) (within (- p2 x2) (* 2.0 u n2))
             (within (- p3 x3) (* 2.0 u n3))
             (within (- s (+ p1 p2)) (* u (+ (most n1) (most n2))))
             (within (- V (+ s p3)) (* u (+ s-most (most n3))))))
(check-sat) ; sat
(assert (not (within (- V (+ x1 x2 x3 y1 y2 y3)) (* 48.5 u M))))
(check-sat)
(pop)

; Claim, for any format: (48.5 G + 3.2) / (1 - r) < 2^6 max(G, 1), with r = 48.5 u G. Assumed: G <= 1 or, for FracWidth
; > 11, G <= 2^(FracWidth - 11) = 1 / (4096 u). G = 2^g, with g = largest exponent of N's components minus exponent of
; V.
(push)
(declare-const u Real)
(declare-const G Real)
(define-fun r () Real (* 48.5 u G))
(assert (and (< 0.0 u) (<= u (/ 1.0 256.0)) (< 0.0 G) (or (<= G 1.0) (<= (* 4096.0 u G) 1.0))))
(check-sat) ; sat
(assert (not (and (<= r 0.2)
                  (< (+ (* 48.5 G) 3.2) (* 64.0 (ite (< G 1.0) 1.0 G) (- 1.0 r))))))
(check-sat)
(pop)
