; What claims/multiply.smt2 assumes of a product: in whole numbers, with f = 2^fraction, a significand a of
; any number and b of a normal one. For z3: "unsat" to each question.
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
