; Specification of a == b, a < b and unordered. IEEE 754-2019, clauses 5.6.1, 5.11 and 7.2.

(define-fun is-unordered ((a Word) (b Word)) Bool
  (or (fp.isNaN (number a)) (fp.isNaN (number b))))
(define-fun compare-flags ((a Word) (b Word) (signaling Bool)) (_ BitVec 5)
  (concat
    (bit (or (is-signaling a) (is-signaling b) (and signaling (is-unordered a b))))
    #b0000))
