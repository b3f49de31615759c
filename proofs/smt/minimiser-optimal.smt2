; The closed form of the local minimiser is optimal, for two links.
;
; minimise w1 T1^2 + w2 T2^2 - b1 T1 - b2 T2 over T >= 0, T1 + T2 <= B. The closed form is
; Tj = max(0, bj - mu) / (2 wj) with mu >= 0 and mu (T1 + T2 - B) = 0 (`local_minimiser`).
;
; Lemma: no feasible S has a smaller objective.
(set-logic QF_NRA)
(declare-const w1 Real) (declare-const w2 Real)
(declare-const b1 Real) (declare-const b2 Real)
(declare-const T1 Real) (declare-const T2 Real)
(declare-const S1 Real) (declare-const S2 Real)
(declare-const B Real) (declare-const mu Real)
(define-fun part ((x Real)) Real (ite (> x 0) x 0))
(assert (and (> w1 0) (> w2 0) (> B 0) (>= mu 0)))
(assert (= (* 2 w1 T1) (part (- b1 mu))))
(assert (= (* 2 w2 T2) (part (- b2 mu))))
(assert (<= (+ T1 T2) B))
(assert (= (* mu (- (+ T1 T2) B)) 0))
(assert (and (>= S1 0) (>= S2 0) (<= (+ S1 S2) B)))
(check-sat) ; expect sat
(assert (< (+ (* w1 S1 S1) (* w2 S2 S2) (- (* b1 S1)) (- (* b2 S2)))
           (+ (* w1 T1 T1) (* w2 T2 T2) (- (* b1 T1)) (- (* b2 T2)))))
(check-sat) ; expect unsat
