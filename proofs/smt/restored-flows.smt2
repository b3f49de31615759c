; Robots that go back to their former flows fit together with those that do not, for any number of
; robots.
;
; Robots that are restored send what they sent before, all others what is new. A restored robot has
; the robot at the other end of each flow that has changed restored too (`restore_flows`). Then what
; a restored robot receives is what it received before, and what any other receives is what is new:
; the residual of each is that of its former flows, or that of its new ones.
(declare-sort Robot 0)
(declare-sort Flow 0)
(declare-fun before (Robot Robot) Flow)
(declare-fun now (Robot Robot) Flow)
(declare-fun restored (Robot) Bool)
(define-fun sent ((i Robot) (j Robot)) Flow (ite (restored i) (before i j) (now i j)))
(define-fun shares ((i Robot) (j Robot)) Bool
  (or (not (= (before i j) (now i j))) (not (= (before j i) (now j i)))))
(define-fun passed-on () Bool
  (forall ((i Robot) (j Robot)) (=> (and (restored i) (shares i j)) (restored j))))
(define-fun fits () Bool
  (forall ((i Robot) (j Robot))
    (= (sent i j) (ite (restored j) (before i j) (now i j)))))
(declare-const some Robot) (declare-const other Robot)
(assert (and (restored some) (not (restored other))))
(push)
(assert passed-on)
(check-sat) ; expect sat
(assert (not fits))
(check-sat) ; expect unsat
(pop)
; If it is not passed on, flows do not fit together.
(assert (not fits))
(check-sat) ; expect sat
