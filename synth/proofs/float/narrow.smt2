; Specification for bfloat16, a format that the solver does not support. A bfloat16 number is represented as a binary32
; number with a lower half of zeros. No operation of SMT-LIB rounds to bfloat16. Instead, by clause 4.3, a result is
; right if its magnitude is the largest one that the exact value reaches when rounded. To be read after format.smt2.

; Place k = 2 n: bfloat16 magnitude number n in ascending order from 0 (n is its word); odd k: the middle between two
; magnitudes. After the largest finite magnitude comes the next power of two.
(define-sort Place () (_ BitVec $W))
(define-fun at ((k Place)) Wide
  (ite (= k $INFINITY_PLACE) $POWER
       ((_ to_fp $WE $WS) RNE ((_ to_fp $E $FS) (concat #b0 k (_ bv0 $NARROW_PAD))))))

; Whether an exact magnitude between `least` and `most` (equal or neighbouring Wides) rounds to place k (even) or above.
(define-fun reaches-place ((m RoundingMode) (negative Bool) (least Wide) (most Wide) (k Place)) Bool
  (let ((middle (at (bvsub k (_ bv1 $W)))) (even (= ((_ extract 1 1) k) #b0)))
    (ite (or (= m RNA) (and (= m RNE) even)) (fp.geq least middle)
    (ite (= m RNE) (fp.gt most middle)
    (ite (= m (ite negative RTN RTP)) (fp.gt most (at (bvsub k (_ bv2 $W))))
         (fp.geq least (at k)))))))

(define-fun place-of ((w Word)) Place (concat ((_ extract $FIELD_HIGH 0) w) #b0))
(define-fun is-rounding ((w Word) (m RoundingMode) (negative Bool) (least Wide) (most Wide)) Bool
  (let ((k (place-of w)) (to-infinity (or (= m RNE) (= m RNA) (= m (ite negative RTN RTP)))))
    (and (= (is-negative w) negative)
         (ite (reaches-place m negative least most $INFINITY_PLACE)
              (= k (ite to-infinity $INFINITY_PLACE (bvsub $INFINITY_PLACE (_ bv2 $W))))
              (and (bvult k $INFINITY_PLACE)
                   (or (= k (_ bv0 $W)) (reaches-place m negative least most k))
                   (not (reaches-place m negative least most (bvadd k (_ bv2 $W)))))))))

; Whether `w` and `flagged` are the right result and flags of an exact value between `below` and `above`, equal or
; neighbouring Wides. `sign` has the sign of the value, even for zero. `special`: the right result is `special-result`.
(define-fun right ((w Word) (flagged (_ BitVec 5)) (m RoundingMode) (after Bool)
                   (special Bool) (special-result Float) (sign Wide) (below Wide) (above Wide)
                   (invalid Bool) (by-zero Bool)) Bool
  (let ((negative (fp.isNegative sign))
        (least (fp.abs (ite (fp.isNegative above) above below)))
        (most (fp.abs (ite (fp.isNegative above) below above))))
    (let ((exact (and (fp.eq below above) (= (at (place-of w)) most)
                      (not (= (place-of w) $INFINITY_PLACE)))))
      (and (ite special (represents w special-result) (is-rounding w m negative least most))
           (= flagged (flags invalid by-zero (not special) m after
                             (_ +zero $E $FS) (ite exact (_ +zero $E $FS) (_ +oo $E $FS))
                             below above))))))

(define-fun add-right ((w Word) (flagged (_ BitVec 5)) (m RoundingMode) (after Bool)
                       (a Word) (b Word) (subtract Bool)) Bool
  (let ((x (wide a)) (y (ite subtract (fp.neg (wide b)) (wide b))))
    (right w flagged m after (not (and (is-finite a) (is-finite b))) (add-result m a b subtract)
           (fp.add m x y) (fp.add RTN x y) (fp.add RTP x y)
           (= ((_ extract 4 4) (add-flags m after a b subtract)) #b1) false)))
