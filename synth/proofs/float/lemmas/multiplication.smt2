; The assumption of claims/multiply.smt2 about a product, in integers. a and b are significands, f = 2^(fraction bits).
; In the first question, b is the significand of a normal number. z3 must answer "unsat" to each question.
(declare-const a Int)
(declare-const b Int)
(declare-const f Int)
(assert (and (> f 0) (<= 0 a) (< a (* 2 f)) (<= 0 b) (< b (* 2 f))))

(push)
(assert (<= f b))
(assert (not (and (<= (* a f) (* a b)) (or (< (* a b) (* a (* 2 f))) (= (* a b) (* a f))))))
(check-sat)
(pop)

(push)
(assert (not (= (= (* a b) 0) (or (= a 0) (= b 0)))))
(check-sat)
(pop)
