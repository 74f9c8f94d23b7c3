; Specification of a / b, in terms of the truncated quotient of the significands and whether there is a remainder. IEEE
; 754-2019, clauses 5.4.1 and 7. To be read after multiply.smt2.
;
; wide-a and wide-b are the words of a and b converted to Wide. As a Wide, every nonzero number is
; normal. The fields of these words are therefore normalised exponents and fractions.

(define-sort WideWord () (_ BitVec $WW))
(define-sort Quotient () (_ BitVec $Q))  ; fixed point, with two integer bits

(define-fun is-word-of ((w WideWord) (x Word)) Bool (= ((_ to_fp $WE $WS) w) (wide x)))
(define-fun wide-field ((w WideWord)) (_ BitVec $WE) ((_ extract $WFIELD_HIGH $WF) w))
(define-fun normalized ((w WideWord)) (_ BitVec $S)
  (concat #b1 ((_ extract $WF_TOP $WF_S) w)))

; The divider of significands returns `quotient` = 2 a / b, truncated, and `left` if there is a remainder. Of `quotient`
; only this is assumed: it is at least 1. (2 a / b is in (1, 4).)
(define-fun possible-quotient ((quotient Quotient)) Bool
  (bvuge quotient (_ bv$QUOTIENT_ONE $Q)))

; The exact quotient as a Wide. (1 + word / 2^k) * 2^e - 2^e = word * 2^(e - k). A remainder counts as half a unit in
; the last place of the quotient. This place is so low that the remainder's size cannot affect rounding:
; claims/sticky.smt2.
(define-fun quotient-magnitude ((wide-a WideWord) (wide-b WideWord)
                                (quotient Quotient) (left Bool))
                               Wide
  (let ((e (bvadd (bvsub (wide-field wide-a) (wide-field wide-b)) (_ bv$QUOTIENT_FIELD $WE))))
    (fp.sub RNE (fp #b0 e (concat (_ bv0 $QPAD) quotient (bit left))) (fp #b0 e (_ bv0 $WF)))))

(define-fun divide-invalid ((a Word) (b Word)) Bool
  (or (is-signaling a) (is-signaling b)
      (and (fp.isInfinite (number a)) (fp.isInfinite (number b)))
      (and (fp.isZero (number a)) (fp.isZero (number b)))))
(define-fun by-zero ((a Word) (b Word)) Bool
  (and (fp.isZero (number b)) (is-finite a) (not (fp.isZero (number a)))))
(define-fun is-quotient ((a Word) (b Word)) Bool
  (and (is-finite a) (is-finite b) (not (fp.isZero (number a))) (not (fp.isZero (number b)))))

; `magnitude`: the value of quotient-magnitude.
(define-fun divide-result ((m RoundingMode) (a Word) (b Word) (magnitude Wide)) Float
  (let ((same (= (is-negative a) (is-negative b))))
    (ite (or (fp.isNaN (number a)) (fp.isNaN (number b)) (divide-invalid a b)) (_ NaN $E $FS)
    (ite (or (fp.isInfinite (number a)) (fp.isZero (number b)))
         (ite same (_ +oo $E $FS) (_ -oo $E $FS))
    (ite (or (fp.isZero (number a)) (fp.isInfinite (number b)))
         (ite same (_ +zero $E $FS) (_ -zero $E $FS))
         ((_ to_fp $E $FS) m (ite same magnitude (fp.neg magnitude))))))))

(define-fun divide-flags ((m RoundingMode) (after Bool) (a Word) (b Word) (magnitude Wide))
                         (_ BitVec 5)
  (let ((x (ite (= (is-negative a) (is-negative b)) magnitude (fp.neg magnitude))))
    (flags
      (divide-invalid a b)
      (by-zero a b)
      (is-quotient a b)
      m after
      ((_ to_fp $E $FS) RTN x) ((_ to_fp $E $FS) RTP x)
      x x)))
