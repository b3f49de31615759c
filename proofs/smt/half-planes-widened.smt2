; A robot that is already closer than 2 rho to another comes no nearer.
;
; The robots stand at x = -h and x = h, 0 <= h < rho, which is no loss: distances do not depend on
; where the axes lie. The half-planes of `own_side` are then widened to the robots: the first may
; go to p with px <= -h, the second to q with qx >= h.
;
; Lemma: |p - q|^2 >= (2 h)^2, the square of their distance now.
(set-logic QF_NRA)
(declare-const h Real)
(declare-const rho Real)
(declare-const px Real)
(declare-const py Real)
(declare-const qx Real)
(declare-const qy Real)
(assert (and (<= 0 h) (< h rho)))
(assert (<= px (ite (>= (- h) (- rho)) (- h) (- rho))))
(assert (>= qx (ite (<= h rho) h rho)))
(check-sat) ; expect sat
(assert (< (+ (* (- px qx) (- px qx)) (* (- py qy) (- py qy))) (* 4 h h)))
(check-sat) ; expect unsat
