; Points that move on segments stay in their half-planes, each at its own pace.
;
; A point moves from p to p' with n . p <= c and n . p' <= c; its place at any time is
; p + t (p' - p) with 0 <= t <= 1. With c = b - rho this is one robot, and with -n, -b - rho the
; other: so the lemma of half-planes.smt2 holds at every pair of places on the way, whatever the
; paces, and two robots that go from cell to cell stay 2 rho apart while they move. The walls of
; the region P of eq. (18) are half-planes, too: clearance is kept in the same way.
;
; Lemma: n . (p + t (p' - p)) <= c.
(set-logic QF_NRA)
(declare-const nx Real)
(declare-const ny Real)
(declare-const c Real)
(declare-const px Real)
(declare-const py Real)
(declare-const rx Real)
(declare-const ry Real)
(declare-const t Real)
(assert (<= (+ (* nx px) (* ny py)) c))
(assert (<= (+ (* nx rx) (* ny ry)) c))
(assert (<= 0 t 1))
(check-sat) ; expect sat
(assert (> (+ (* nx (+ px (* t (- rx px)))) (* ny (+ py (* t (- ry py))))) c))
(check-sat) ; expect unsat
