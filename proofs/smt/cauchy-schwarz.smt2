; Cauchy and Schwarz in the plane, which distance-convex.smt2 uses.
;
; Lemma: (u . v)^2 <= |u|^2 |v|^2; hence u . v <= a b for a = |u|, b = |v|, as a b >= 0.
(set-logic QF_NRA)
(declare-const ux Real)
(declare-const uy Real)
(declare-const vx Real)
(declare-const vy Real)
(check-sat) ; expect sat
(assert (> (* (+ (* ux vx) (* uy vy)) (+ (* ux vx) (* uy vy)))
           (* (+ (* ux ux) (* uy uy)) (+ (* vx vx) (* vy vy)))))
(check-sat) ; expect unsat
