; From the rows to the quotient, in integers of any size. x, d: the significands; p = 4^r; D: the digits
; up to row r as one number; w: residual after row r. z3 must answer "unsat" to each question.
(declare-const x Int)
(declare-const d Int)
(declare-const p Int)
(declare-const D Int)
(declare-const w Int)
(declare-const digit Int)

; Every row preserves 2 x p = D d + w. (After the first row, p = 1 and w = 2 x - D d.) A row replaces
; p by 4 p, D by 4 D + digit, and w by 4 w - digit d.
(push)
(assert (= (* 2 x p) (+ (* D d) w)))
(assert (not (= (* 2 x (* 4 p)) (+ (* (+ (* 4 D) digit) d) (- (* 4 w) (* digit d))))))
(check-sat)
(pop)

; After the last row: Q = D, minus one if w < 0, is 2 x p / d truncated. There is a remainder if and only if w is not 0.
(push)
(define-fun Q () Int (ite (< w 0) (- D 1) D))
(assert (and (> d 0) (<= (* -2 d) (* 3 w)) (<= (* 3 w) (* 2 d))))
(assert (= (* 2 x p) (+ (* D d) w)))
(assert (not (and (<= (* Q d) (* 2 x p)) (< (* 2 x p) (+ (* Q d) d))
                  (= (= w 0) (= (* 2 x p) (* Q d))))))
(check-sat)
(pop)

; The quotient is in (p, 4 p) if the significands are in [f, 2 f), so two integer bits are enough.
(push)
(declare-const f Int)
(assert (and (> f 0) (<= f x) (< x (* 2 f)) (<= f d) (< d (* 2 f)) (> p 0)))
(assert (not (and (< d (* 2 x)) (< (* 2 x) (* 4 d)))))
(check-sat)
(pop)
