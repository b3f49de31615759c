; What a robot knows of an election, or of the newest notice, was placed by a robot, and is at least
; what this one has placed itself, whatever messages are lost, copied or overtaken; for any number of
; robots. Two robots that know of everything placed agree on the best.
;
; The step is `merge` of `Election` and of `Bulletin`: hearing takes the maximum.
(declare-sort Robot 0)
(declare-sort Message 0)
(declare-sort Bid 0)
(declare-fun at-most (Bid Bid) Bool)            ; a total order
(assert (forall ((x Bid)) (at-most x x)))
(assert (forall ((x Bid) (y Bid) (z Bid)) (=> (and (at-most x y) (at-most y z)) (at-most x z))))
(assert (forall ((x Bid) (y Bid)) (=> (and (at-most x y) (at-most y x)) (= x y))))
(assert (forall ((x Bid) (y Bid)) (or (at-most x y) (at-most y x))))
(declare-fun placed (Robot Bid) Bool)           ; each places what it likes, one bid or more
(declare-fun best (Robot) Bid)
(declare-fun said (Message) Bid)                ; all that was ever said, and may be heard at any time
(declare-fun sound (Bid) Bool)                  ; somebody has placed it
(assert (forall ((r Robot) (x Bid)) (=> (placed r x) (at-most x (best r)))))
(assert (forall ((r Robot) (x Bid)) (=> (placed r x) (sound x))))
(assert (forall ((r Robot)) (sound (best r))))
(assert (forall ((m Message)) (sound (said m))))
(push)
(check-sat) ; expect sat
(pop)
; A robot hears any message, and takes the maximum.
(declare-const receiver Robot) (declare-const m Message)
(define-fun best2 ((r Robot)) Bid
  (ite (and (= r receiver) (not (at-most (said m) (best r)))) (said m) (best r)))
(push)
(declare-const r Robot) (declare-const x Bid)
(assert (or (and (placed r x) (not (at-most x (best2 r)))) (not (sound (best2 r)))
            (not (at-most (best r) (best2 r)))))
(check-sat) ; expect unsat
(pop)
; Two robots that know as much as every robot has placed agree.
(declare-const one Robot) (declare-const other Robot)
(assert (forall ((r Robot) (x Bid))
  (=> (placed r x) (and (at-most x (best2 one)) (at-most x (best2 other))))))
(declare-const first Robot) (declare-const second Robot) ; those that placed what they know: it is sound
(assert (and (placed first (best2 one)) (placed second (best2 other))))
(push)
(check-sat) ; expect sat
(pop)
(assert (not (= (best2 one) (best2 other))))
(check-sat) ; expect unsat
