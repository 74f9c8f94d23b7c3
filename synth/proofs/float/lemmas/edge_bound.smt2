; Claim, in binary32: |U - I . E| <= bound, so U has the sign of I . E if |U| > bound. The steps are those of
; host/intersect/polygon_record.cpp. z3 must answer "sat" where a question says so (then its assumptions are
; possible), else "unsat". All values are real numbers.
;   I: the ray's direction, |I_i| <= 2. E: the exact edge vector. D: E in double. F: D in float, the record's words.
;   U: I . F as the unit computes it. An operation has an error of at most u = 2^-24 (the unit roundoff) times its
;   exact result, and of 2^-150 more if a product underflows (sums do not underflow).
;   f_i = |F_i|, g_i = |D_i - F_i|, h_i = |E_i - D_i|. x_i = I_i F_i, y_i = I_i (D_i - F_i), z_i = I_i (E_i - D_i):
;   z3 knows only bounds of these products, so the questions are linear.
(set-logic QF_LRA)
(define-fun u () Real (/ 1.0 16777216.0))
(define-fun tiny () Real (/ 1.0 1427247692705959881058285969449495136382746624.0)) ; 2^-150
(define-fun within ((x Real) (bound Real)) Bool (and (<= x bound) (<= (- bound) x)))

(declare-const f1 Real) (declare-const f2 Real) (declare-const f3 Real)
(declare-const g1 Real) (declare-const g2 Real) (declare-const g3 Real)
(declare-const h1 Real) (declare-const h2 Real) (declare-const h3 Real)
(define-fun size () Real (+ f1 f2 f3))
(define-fun size-in-double () Real (+ f1 g1 f2 g2 f3 g3))
(assert (and (<= 0.0 f1) (<= 0.0 f2) (<= 0.0 f3)))
(assert (>= size (/ 1.0 1152921504606846976.0))) ; 2^-60
(assert (and (<= 0.0 g1 (+ (* u f1) tiny)) (<= 0.0 g2 (+ (* u f2) tiny))
             (<= 0.0 g3 (+ (* u f3) tiny))))
(define-fun h-most () Real (/ size-in-double 17179869184.0)) ; 2^-34, guaranteed by edge_normal
(assert (and (<= 0.0 h1 h-most) (<= 0.0 h2 h-most) (<= 0.0 h3 h-most)))

(declare-const x1 Real) (declare-const x2 Real) (declare-const x3 Real)
(declare-const y1 Real) (declare-const y2 Real) (declare-const y3 Real)
(declare-const z1 Real) (declare-const z2 Real) (declare-const z3 Real)
(assert (and (within x1 (* 2.0 f1)) (within x2 (* 2.0 f2)) (within x3 (* 2.0 f3))))
(assert (and (within y1 (* 2.0 g1)) (within y2 (* 2.0 g2)) (within y3 (* 2.0 g3))))
(assert (and (within z1 (* 2.0 h1)) (within z2 (* 2.0 h2)) (within z3 (* 2.0 h3))))
(define-fun exact () Real (+ x1 x2 x3 y1 y2 y3 z1 z2 z3))

; The unit's three products p_i, first sum s and second sum U, and their largest magnitudes.
(declare-const p1 Real) (declare-const p2 Real) (declare-const p3 Real)
(declare-const s Real) (declare-const U Real)
(define-fun product-error ((f Real)) Real (+ (* u 2.0 f) tiny))
(define-fun product-most ((f Real)) Real (+ (* 2.0 f) (product-error f)))
(define-fun s-exact-most () Real (+ (product-most f1) (product-most f2)))
(define-fun s-most () Real (+ s-exact-most (* u s-exact-most)))
(assert (and (within (- p1 x1) (product-error f1)) (within (- p2 x2) (product-error f2))
             (within (- p3 x3) (product-error f3))
             (within (- s (+ p1 p2)) (* u s-exact-most))
             (within (- U (+ s p3)) (* u (+ s-most (product-most f3))))))

; bound = kEdgeBound u (f_1 + f_2 + f_3), less a part of 10^-9 for rounding errors in its evaluation.
(define-fun bound () Real (* 8.0078125 0.999999999 u size))

(check-sat) ; sat

(push)
(assert (not (within (- U exact) bound)))
(check-sat)
(pop)

; If |U| > bound, U has the sign of the exact product.
(push)
(assert (or (and (> U bound) (<= exact 0.0)) (and (< U (- bound)) (>= exact 0.0))))
(check-sat)
(pop)
