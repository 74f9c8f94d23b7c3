; Shared by the specifications: words, numbers, the five flags. IEEE 754-2019, clauses 3.4, 4.3, 7.
;
; All operations are those of SMT-LIB's theory FloatingPoint. $$E and $$S stand for the widths of the
; exponent and of the significand with its integer bit (binary16: 5, 11).

(define-sort Word () (_ BitVec $W))
(define-sort Float () (_ FloatingPoint $E $FS))
; The next wider IEEE format. Products of two Floats, and numbers midway between Floats, are exact as Wides.
(define-sort Wide () (_ FloatingPoint $WE $WS))

(define-fun number ((w Word)) Float ((_ to_fp $E $FS) $HELD))
(define-fun wide ((w Word)) Wide ((_ to_fp $WE $WS) RNE (number w)))
(define-fun is-negative ((w Word)) Bool (= ((_ extract $SIGN $SIGN) w) #b1))
(define-fun is-finite ((w Word)) Bool
  (not (or (fp.isNaN (number w)) (fp.isInfinite (number w)))))

; A NaN is signalling if the first bit of its fraction is 0. Every NaN result is the canonical NaN.
(define-fun is-signaling ((w Word)) Bool
  (and (fp.isNaN (number w)) (= ((_ extract $QUIET $QUIET) w) #b0)))
(define-fun canonical-nan () Word $NAN)

; Whether `w` is the word of `x`.
(define-fun represents ((w Word) (x Float)) Bool
  (ite (fp.isNaN x) (= w canonical-nan) (= (number w) x)))

; RISC-V's encoding of the rounding modes. The three unused values round towards zero.
(define-fun mode ((m (_ BitVec 3))) RoundingMode
  (ite (= m #b000) RNE (ite (= m #b010) RTN (ite (= m #b011) RTP (ite (= m #b100) RNA RTZ)))))

; Whether a magnitude, rounded with unbounded exponent range, reaches `power`, a power of two. The
; magnitude is between `least` and `most`, equal or neighbouring Wides. `last`: the number before
; `power`. `middle`: halfway between `last` and `power` (a tie rounds to `power`, which is even).
(define-fun reaches ((m RoundingMode) (negative Bool) (least Wide) (most Wide)
                     (last Wide) (middle Wide) (power Wide)) Bool
  (ite (or (= m RNE) (= m RNA)) (fp.geq least middle)
  (ite (= m (ite negative RTN RTP)) (fp.gt most last)
       (fp.geq least power))))

; The flags of a result, from left to right: invalid, division by zero, overflow, underflow, inexact. Arguments:
;   rounds         the result is the rounding of an exact finite value
;   down, up       the Floats below and above the exact value; equal if it is a Float, else the result is inexact (7.6)
;   below, above   the Wides below and above the exact value; equal if it is a Wide
; Overflow (7.4): the rounded value reaches the power of two beyond the largest Float. Underflow (7.5): inexact, and the
; value, rounded in mode m (tininess after rounding) or truncated (before), is below the smallest normal Float.
(define-fun bit ((p Bool)) (_ BitVec 1) (ite p #b1 #b0))
(define-fun flags ((invalid Bool) (by-zero Bool) (rounds Bool) (m RoundingMode) (after Bool)
                   (down Float) (up Float) (below Wide) (above Wide)) (_ BitVec 5)
  (let ((inexact (and rounds (not (fp.eq down up))))
        (negative (fp.isNegative above))
        (least (fp.abs (ite (fp.isNegative above) above below)))
        (most (fp.abs (ite (fp.isNegative above) below above))))
    (concat
      (bit invalid)
      (bit by-zero)
      (bit (and rounds (reaches m negative least most $OVERFLOW)))
      (bit (and inexact (not (reaches (ite after m RTZ) negative least most $UNDERFLOW))))
      (bit inexact))))
