; Points in their own half-planes, each shrunk by rho, are 2 rho apart.
;
; The bisector of two robots has the unit normal n = (nx, ny), pointing from the first to the
; second, and the offset b: it is the set of q with n . q = b. The half-planes of eq. (17), shrunk
; by rho, are n . p <= b - rho for the first robot and n . q >= b + rho for the second
; (`own_side`, for robots at least 2 rho apart).
;
; Lemma: |q - p|^2 >= (2 rho)^2. The bisector may lie in any direction.
(set-logic QF_NRA)
(declare-const nx Real)
(declare-const ny Real)
(declare-const px Real)
(declare-const py Real)
(declare-const qx Real)
(declare-const qy Real)
(define-fun along ((x Real) (y Real)) Real (+ (* nx x) (* ny y)))
(define-fun across ((x Real) (y Real)) Real (- (* nx y) (* ny x)))
(define-fun dx () Real (- qx px))
(define-fun dy () Real (- qy py))
; First, the identity of Lagrange: what lies along n and across it makes up the whole.
(push)
(assert (distinct (+ (* (along dx dy) (along dx dy)) (* (across dx dy) (across dx dy)))
                  (* (+ (* nx nx) (* ny ny)) (+ (* dx dx) (* dy dy)))))
(check-sat) ; expect unsat
(pop)
; Then the lemma, in terms of the projections n . p and n . q, for |n| = 1.
(declare-const b Real)
(declare-const rho Real)
(declare-const np Real)
(declare-const nq Real)
(declare-const c Real)
(declare-const squared-distance Real)
(assert (> rho 0))
(assert (<= np (- b rho)))
(assert (>= nq (+ b rho)))
(assert (= squared-distance (+ (* (- nq np) (- nq np)) (* c c))))
(check-sat) ; expect sat
(assert (< squared-distance (* 4 rho rho)))
(check-sat) ; expect unsat
