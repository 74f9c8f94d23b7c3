; fp_compare: every pair of words.
(define-fun assumed () Bool true)
(define-fun claimed () Bool
  (and (= equal_o (fp.eq (number a_i) (number b_i)))
       (= less_o (fp.lt (number a_i) (number b_i)))
       (= unordered_o (is-unordered a_i b_i))
       (= flags_o (compare-flags a_i b_i signaling_i))))
