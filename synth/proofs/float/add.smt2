; Specification of a + b, or with `subtract` of a - b = a + (-b). IEEE 754-2019, clauses 5.4.1,
; 6.3 and 7.

(define-fun addend ((b Word) (subtract Bool)) Float
  (ite subtract (fp.neg (number b)) (number b)))

(define-fun add-result ((m RoundingMode) (a Word) (b Word) (subtract Bool)) Float
  (fp.add m (number a) (addend b subtract)))

(define-fun add-flags ((m RoundingMode) (after Bool) (a Word) (b Word) (subtract Bool))
                      (_ BitVec 5)
  (let ((x (number a)) (y (addend b subtract))
        (wide-x (wide a)) (wide-y (ite subtract (fp.neg (wide b)) (wide b))))
    (flags
      (or (is-signaling a) (is-signaling b)
          (and (fp.isInfinite x) (fp.isInfinite y) (not (= x y))))
      false
      (and (is-finite a) (is-finite b))
      m after
      (fp.add RTN x y) (fp.add RTP x y)
      (fp.add RTN wide-x wide-y) (fp.add RTP wide-x wide-y))))
