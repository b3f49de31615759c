; Exchanges neither lose a duty nor give it to two robots, for any number of robots that exchange duties
; with one another, whichever beacons are lost, late or copied, and whichever robots stop.
;
; A mover makes offers, one after the other (`make_offer`); a parked robot answers an offer once
; (`asks`, `answer`), and gives its duty only while it offers none itself (the table `EXCHANGE`); the mover
; takes the duty given (`hear`); then the parked robot takes what was offered (`conclude`). What is heard
; is anything that was ever told. A robot that begins again is another one here.
;
; The duty in effect of a robot that gives its own is the one offered, once the mover has given its offer up.
(declare-sort Robot 0)
(declare-sort Offer 0)
(declare-sort Duty 0)
; An offer: who made it, to whom, and what was offered; once it has been answered, whether the answer was a
; duty, and which. Offers of one robot are in the order of their numbers; before the first one stands none.
(declare-fun by (Offer) Robot)
(declare-fun to (Offer) Robot)
(declare-fun what (Offer) Duty)
(declare-fun accepts (Offer) Bool)
(declare-fun given (Offer) Duty)
(declare-fun at-most (Offer Offer) Bool)
(assert (forall ((o Offer)) (at-most o o)))
(assert (forall ((o Offer) (p Offer) (q Offer)) (=> (and (at-most o p) (at-most p q)) (at-most o q))))
(assert (forall ((o Offer) (p Offer)) (=> (and (at-most o p) (at-most p o)) (= o p))))
(assert (forall ((o Offer) (p Offer)) (or (at-most o p) (at-most p o))))
; The state: what a robot does, its last offer, and whether that stands; whether its reply stands that gives
; its duty, and for which offer; which offers have been answered; and which beacons have been told: of the
; robot that made it, by its last offer, and whether that stood.
(declare-fun duty (Robot) Duty) (declare-fun duty2 (Robot) Duty)
(declare-fun last (Robot) Offer) (declare-fun last2 (Robot) Offer)
(declare-fun offers (Robot) Bool) (declare-fun offers2 (Robot) Bool)
(declare-fun gives (Robot) Bool) (declare-fun gives2 (Robot) Bool)
(declare-fun for (Robot) Offer) (declare-fun for2 (Robot) Offer)
(declare-fun answered (Offer) Bool) (declare-fun answered2 (Offer) Bool)
(declare-fun told (Offer Bool) Bool) (declare-fun told2 (Offer Bool) Bool)
(define-fun stands ((o Offer)) Bool (and (offers (by o)) (= (last (by o)) o)))
(define-fun stands2 ((o Offer)) Bool (and (offers2 (by o)) (= (last2 (by o)) o)))
(define-fun in-effect ((r Robot)) Duty (ite (and (gives r) (not (stands (for r)))) (what (for r)) (duty r)))
(define-fun in-effect2 ((r Robot)) Duty (ite (and (gives2 r) (not (stands2 (for2 r)))) (what (for2 r)) (duty2 r)))
; The promise is the first line; the rest is what makes it inductive.
(define-fun before () Bool (and
  (forall ((x Robot) (y Robot)) (=> (= (in-effect x) (in-effect y)) (= x y)))
  (forall ((r Robot)) (and (= (by (last r)) r)
    (=> (offers r) (and (= (what (last r)) (duty r)) (not (gives r))))))
  (forall ((x Offer)) (=> (answered x) (at-most x (last (by x)))))
  (forall ((x Offer) (s Bool)) (=> (told x s) (and (at-most x (last (by x)))
    (=> (and s (not (answered x))) (stands x)) (=> (not s) (not (stands x))))))
  (forall ((r Robot)) (=> (gives r) (and (answered (for r)) (accepts (for r)) (= (to (for r)) r)
    (= (given (for r)) (duty r)))))
  (forall ((x Offer)) (=> (and (stands x) (answered x) (accepts x))
    (and (gives (to x)) (= (for (to x)) x))))))
(define-fun after () Bool (and
  (forall ((x Robot) (y Robot)) (=> (= (in-effect2 x) (in-effect2 y)) (= x y)))
  (forall ((r Robot)) (and (= (by (last2 r)) r)
    (=> (offers2 r) (and (= (what (last2 r)) (duty2 r)) (not (gives2 r))))))
  (forall ((x Offer)) (=> (answered2 x) (at-most x (last2 (by x)))))
  (forall ((x Offer) (s Bool)) (=> (told2 x s) (and (at-most x (last2 (by x)))
    (=> (and s (not (answered2 x))) (stands2 x)) (=> (not s) (not (stands2 x))))))
  (forall ((r Robot)) (=> (gives2 r) (and (answered2 (for2 r)) (accepts (for2 r)) (= (to (for2 r)) r)
    (= (given (for2 r)) (duty2 r)))))
  (forall ((x Offer)) (=> (and (stands2 x) (answered2 x) (accepts x))
    (and (gives2 (to x)) (= (for2 (to x)) x))))))
; Robot a takes a step: nothing changes of any other.
(declare-const a Robot) (declare-const b Robot) (declare-const o Offer) (declare-const stood Bool)
(define-fun others-rest () Bool (forall ((r Robot)) (=> (not (= r a)) (and (= (duty2 r) (duty r))
  (= (last2 r) (last r)) (= (offers2 r) (offers r)) (= (gives2 r) (gives r)) (= (for2 r) (for r))))))
(define-fun tells-nothing () Bool (forall ((x Offer) (s Bool)) (= (told2 x s) (told x s))))
(define-fun answers-nothing () Bool (forall ((x Offer)) (= (answered2 x) (answered x))))
(define-fun answers-o () Bool (forall ((x Offer)) (= (answered2 x) (or (answered x) (= x o)))))
(define-fun offers-as-before () Bool (and (= (last2 a) (last a)) (= (offers2 a) (offers a))))
(define-fun gives-as-before () Bool (and (= (gives2 a) (gives a)) (= (for2 a) (for a))))
(define-fun does-as-before () Bool (= (duty2 a) (duty a)))
(define-fun nothing-is-exchanged () Bool (forall ((r Robot)) (= (in-effect2 r) (in-effect r))))
(define-fun a-and-b-exchange () Bool (and (= (in-effect2 a) (in-effect b)) (= (in-effect2 b) (in-effect a))
  (forall ((r Robot)) (or (= r a) (= r b) (= (in-effect2 r) (in-effect r))))))
(define-fun two-robots () Bool (forall ((r Robot)) (or (= r a) (= r b))))
(assert (and before others-rest))
(push)
(assert (exists ((r Robot)) (and (gives r) (not (stands (for r))))))
(check-sat) ; expect sat
(pop)
; It tells its beacon.
(push)
(assert (and answers-nothing offers-as-before gives-as-before does-as-before))
(assert (forall ((x Offer) (s Bool)) (= (told2 x s) (or (told x s) (and (= x (last a)) (= s (offers a)))))))
(assert (not (and after nothing-is-exchanged)))
(check-sat) ; expect unsat
(pop)
; `make_offer`: in "free" only.
(push)
(assert (and tells-nothing answers-nothing gives-as-before does-as-before))
(assert (and (not (offers a)) (not (gives a)) (offers2 a) (at-most (last a) (last2 a)) (not (= (last a) (last2 a)))
  (= (by (last2 a)) a) (= (what (last2 a)) (duty a))))
(assert (not (and after nothing-is-exchanged)))
(check-sat) ; expect unsat
(pop)
; `answer` with a duty, in "free" only: a hears an offer to it that it has not answered (`asks`).
(push)
(assert (and tells-nothing offers-as-before does-as-before answers-o (told o true) (= (to o) a)
  (not (answered o)) (accepts o) (= (given o) (duty a)) (not (gives a)) (gives2 a) (= (for2 a) o)))
(push)
(assert (not (offers a)))
(assert (not (and after nothing-is-exchanged)))
(check-sat) ; expect unsat
(pop)
; If it could give the duty that it offers to another robot, two could have it.
(assert (and two-robots (not after)))
(check-sat) ; expect sat
(pop)
; `answer` without one.
(push)
(assert (and tells-nothing offers-as-before gives-as-before does-as-before answers-o (told o true) (= (to o) a)
  (not (answered o)) (not (accepts o)) (not (gives a))))
(assert (not (and after nothing-is-exchanged)))
(check-sat) ; expect unsat
(pop)
; `hear`: a, whose offer stands, hears what b has answered to one of its offers.
(push)
(assert (and tells-nothing answers-nothing gives-as-before (= (last2 a) (last a)) (not (offers2 a))))
(assert (and (offers a) (answered o) (= (by o) a) (= (to o) b)
  (= (duty2 a) (ite (accepts o) (given o) (duty a)))))
(push)
(assert (= o (last a)))
(assert (not (and after (ite (accepts o) a-and-b-exchange nothing-is-exchanged))))
(check-sat) ; expect unsat
(pop)
; If the numbers are not compared, a late answer gives a duty that another robot has by now.
(assert (and two-robots (not after)))
(check-sat) ; expect sat
(pop)
; `conclude`: a, which gives its duty, hears that the offer is given up (`has_heard_reply`).
(push)
(assert (and tells-nothing answers-nothing offers-as-before (not (gives2 a))))
(assert (and (gives a) (told o stood) (= (by o) (by (for a))) (not (and stood (= o (for a))))
  (= (duty2 a) (what (for a)))))
(push)
(assert (at-most (for a) o))
(assert (not (and after nothing-is-exchanged)))
(check-sat) ; expect unsat
(pop)
; If what was told before the offer was made counts, both robots have the duty that was offered.
(assert (not after))
(check-sat) ; expect sat
(pop)
; A step of another automaton (guards `disengaged`): a robot at rest takes a duty that none has.
(push)
(assert (and tells-nothing answers-nothing offers-as-before gives-as-before))
(assert (forall ((r Robot)) (=> (not (= r a)) (not (= (duty2 a) (in-effect r))))))
(push)
(assert (and (not (offers a)) (not (gives a))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If it does so while it offers its duty, the other one takes what it does not have.
(assert (and (offers a) two-robots (not after)))
(check-sat) ; expect sat
(pop)
