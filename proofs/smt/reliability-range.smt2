; Eq. (27) between its ends: R = q^2 (3 - 2 q), with q = (u - d) / (u - l) in [0, 1], lies in [0, 1],
; is 0 and 1 at the ends, and its slope with respect to q, 6 q (1 - q), is never negative and is
; zero at both ends. As q falls with d, R falls with d, and it is smooth where it meets the
; constants 1 (d <= l) and 0 (d >= u).
(set-logic QF_NRA)
(declare-const q Real)
(define-fun R ((q Real)) Real (* q q (- 3 (* 2 q))))
(define-fun slope ((q Real)) Real (* 6 q (- 1 q)))
(assert (<= 0 q 1))
(check-sat) ; expect sat
(assert (not (and (<= 0 (R q) 1) (>= (slope q) 0)
                  (= (R 0) 0) (= (R 1) 1) (= (slope 0) 0) (= (slope 1) 0))))
(check-sat) ; expect unsat
