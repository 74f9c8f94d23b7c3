; A nonzero remainder may be replaced by half a unit in the quotient's last place: the quotient with eight more bits,
; not all 0, has the same result and flags as the quotient with half a unit added. For every exponent.
(declare-const quotient Quotient)
(declare-const more (_ BitVec 8))
(declare-const e (_ BitVec $WE))
(declare-const m (_ BitVec 3))
(declare-const after Bool)
(define-fun eight-more () Wide
  (let ((f (bvsub e (_ bv7 $WE))))
    (fp.sub RNE (fp #b0 f (concat (_ bv0 $STICKY_PAD) quotient more)) (fp #b0 f (_ bv0 $WF)))))
(define-fun half () Wide
  (fp.sub RNE (fp #b0 e (concat (_ bv0 $QPAD) quotient #b1)) (fp #b0 e (_ bv0 $WF))))
(define-fun flags-of ((x Wide)) (_ BitVec 5)
  (flags false false true (mode m) after ((_ to_fp $E $FS) RTN x) ((_ to_fp $E $FS) RTP x) x x))
(define-fun assumed () Bool
  (and (possible-quotient quotient) (not (= more #x00))
       (bvuge e (_ bv$STICKY_FROM $WE)) (bvule e (_ bv$STICKY_TO $WE))))
(define-fun claimed () Bool
  (and (= ((_ to_fp $E $FS) (mode m) eight-more) ((_ to_fp $E $FS) (mode m) half))
       (= ((_ to_fp $E $FS) (mode m) (fp.neg eight-more))
          ((_ to_fp $E $FS) (mode m) (fp.neg half)))
       (= (flags-of eight-more) (flags-of half))
       (= (flags-of (fp.neg eight-more)) (flags-of (fp.neg half)))))
