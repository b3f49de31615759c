; No two robots come nearer than they may, for any number of robots and whichever of them have heard of one
; another, however each of them gets on with its move, and whichever stop on the way.
;
; A robot leaves its place in a control period only if it has heard in this period of each robot that could
; come near (`may_leave_place`); then it stays on its own side of the line between the places of both
; (`own_side`, `cell`). What sides of lines have to do with distances is said by the lemmas on half-planes,
; which are assumed here of pairs of places; that nobody is missed who could come near is an assumption on
; the radio (docs/radio.md).
(declare-sort Robot 0)
(declare-sort Place 0)
(declare-fun at (Robot) Place)              ; where it is when the period begins
(declare-fun end (Robot) Place)             ; where its move ends
(declare-fun now (Robot) Place)             ; where it is at some time of the move
(declare-fun moves (Robot) Bool)
(declare-fun heard (Robot Robot) Bool)      ; the first has heard in this period where the second is
(declare-fun expects (Robot Robot) Bool)    ; it takes the second for near, when it was heard last
(declare-fun gone (Robot Robot) Bool)       ; the first goes by a roll that calls the second gone
(declare-fun side (Place Place Place) Bool) ; side(x, y, p): p is on x's own side of the line between x and y
(declare-fun between (Place Place Place) Bool)
(declare-fun near (Place Place) Bool)       ; a step of each could bring them together
(declare-fun in-reach (Place Place) Bool)   ; not farther than a step
(declare-fun kept (Place Place Place Place) Bool) ; kept(x, y, p, q): p and q are 2ρ apart, or no nearer than x and y
; half-planes.smt2 and half-planes-widened.smt2; half-planes-moving.smt2; `widened_to`: one may always stay.
(assert (forall ((x Place) (y Place) (p Place) (q Place)) (=> (and (side x y p) (side y x q)) (kept x y p q))))
(assert (forall ((x Place) (y Place) (p Place) (z Place)) (=> (and (between x z p) (side x y z)) (side x y p))))
(assert (forall ((x Place) (y Place)) (side x y x)))
(assert (forall ((x Place) (y Place)) (= (near x y) (near y x))))
; What is not near is far enough away after a step of both.
(assert (forall ((x Place) (y Place) (p Place) (q Place))
  (=> (and (not (near x y)) (in-reach x p) (in-reach y q)) (kept x y p q))))
(assert (forall ((x Place) (z Place) (p Place)) (=> (and (in-reach x z) (between x z p)) (in-reach x p))))
(assert (forall ((x Place)) (in-reach x x)))
; What robots do.
(assert (forall ((r Robot)) (=> (not (moves r)) (= (now r) (at r)))))
(assert (forall ((r Robot)) (=> (moves r) (and (in-reach (at r) (end r)) (between (at r) (end r) (now r))))))
(assert (forall ((r Robot) (o Robot)) (=> (and (moves r) (heard r o) (near (at r) (at o)))
  (side (at r) (at o) (end r)))))
; The radio: of two robots that could meet, each that moves has heard of the other when that was near.
(assert (forall ((r Robot) (o Robot)) (=> (and (moves r) (near (at r) (at o)) (not (= r o))) (expects r o))))
; One that is called gone does not move (roll.smt2), and others keep off the place where it may be
; (`sides_of_wrecks`).
(assert (forall ((r Robot) (o Robot)) (=> (and (moves r) (gone r o))
  (and (not (moves o)) (kept (at r) (at o) (now r) (at o)) (kept (at o) (at r) (at o) (now r))))))
(define-fun may-leave ((r Robot)) Bool
  (forall ((o Robot)) (=> (and (expects r o) (not (= r o))) (or (heard r o) (gone r o)))))
(define-fun too-near () Bool
  (exists ((r Robot) (o Robot)) (and (not (= r o)) (not (kept (at r) (at o) (now r) (now o))))))
(push)
(assert (forall ((r Robot)) (=> (moves r) (may-leave r))))
(push)
; One moves beside another that has not heard of it.
(assert (exists ((r Robot) (o Robot)) (and (not (= r o)) (moves r) (not (heard o r)) (near (at r) (at o)))))
(check-sat) ; expect sat
(pop)
(assert too-near)
(check-sat) ; expect unsat
(pop)
; If a robot moves as long as it has heard of one of those that are near, or takes silence for absence, two
; may meet.
(declare-const a Robot) (declare-const b Robot) (declare-const c Robot)
(assert (forall ((r Robot)) (or (= r a) (= r b) (= r c))))
(assert (forall ((r Robot)) (=> (moves r) (exists ((o Robot)) (and (not (= r o)) (heard r o))))))
(assert too-near)
(check-sat) ; expect sat
