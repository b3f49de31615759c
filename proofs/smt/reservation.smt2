; A sender never uses more of a link than its receiver keeps for it, whatever becomes of messages.
;
; One link of `reservation.rs`, and one control period, now or ahead: every amount is what holds in it, which is
; nothing where a grant ends before. So leases need no lemma of their own. The sender uses `held`, may use up
; to `granted`, and has asked last with the number `asked`. The receiver keeps `kept`, and has taken in last
; what bore the number `known`. Messages stay on their way for ever: what is heard is any of them, at any
; time, any number of times, or never. An ask carries what is in use when it is sent.
(declare-sort Message 0)
(declare-fun was-ask (Message) Bool)    ; sent before this step, by the sender
(declare-fun was-grant (Message) Bool)  ; sent before this step, by the receiver
(declare-fun is-ask (Message) Bool)     ; sent up to now
(declare-fun is-grant (Message) Bool)
(declare-fun number (Message) Int)
(declare-fun flow (Message) Real)
(declare-const new Message)             ; the message sent in this step, if one is
(declare-const heard Message)           ; the message heard in this step, if one is
(declare-const held Real) (declare-const granted Real) (declare-const asked Int)
(declare-const kept Real) (declare-const known Int)
(declare-const held2 Real) (declare-const granted2 Real) (declare-const asked2 Int)
(declare-const kept2 Real) (declare-const known2 Int)
; The promise is the first line; the rest is what makes it inductive.
(define-fun before () Bool
  (and (<= held granted) (<= granted kept)
       (<= known asked)
       (forall ((m Message)) (=> (was-ask m)
         (and (<= (number m) asked) (=> (> (number m) known) (<= granted (flow m))))))
       (forall ((m Message)) (=> (was-grant m)
         (and (<= (number m) known) (=> (= (number m) known) (<= (flow m) kept)))))))
(define-fun after () Bool
  (and (<= held2 granted2) (<= granted2 kept2)
       (<= known2 asked2)
       (forall ((m Message)) (=> (is-ask m)
         (and (<= (number m) asked2) (=> (> (number m) known2) (<= granted2 (flow m))))))
       (forall ((m Message)) (=> (is-grant m)
         (and (<= (number m) known2) (=> (= (number m) known2) (<= (flow m) kept2)))))))
(define-fun sends-ask () Bool
  (forall ((m Message)) (and (= (is-ask m) (or (was-ask m) (= m new))) (= (is-grant m) (was-grant m)))))
(define-fun sends-grant () Bool
  (forall ((m Message)) (and (= (is-grant m) (or (was-grant m) (= m new))) (= (is-ask m) (was-ask m)))))
(define-fun sends-nothing () Bool
  (forall ((m Message)) (and (= (is-grant m) (was-grant m)) (= (is-ask m) (was-ask m)))))
(define-fun sender-rests () Bool (and (= held2 held) (= granted2 granted) (= asked2 asked)))
(define-fun receiver-rests () Bool (and (= kept2 kept) (= known2 known)))
(assert before)
(check-sat) ; expect sat
; The sender uses more or less, within what is granted.
(push)
(assert (and sends-nothing receiver-rests (= granted2 granted) (= asked2 asked) (<= held2 granted)))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; It asks: what was granted before is void, beyond what is in use now; some of that may end before the period that is
; looked at.
(push)
(assert (and sends-ask receiver-rests (= held2 held) (> asked2 asked)
             (= (number new) asked2) (>= (flow new) held)
             (= granted2 (ite (< (flow new) granted) (flow new) granted))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; The receiver takes in a request that is newer than the last, and keeps what is in use.
(push)
(assert (and sends-nothing sender-rests (was-ask heard) (> (number heard) known)
             (= known2 (number heard)) (= kept2 (ite (< (flow heard) kept) (flow heard) kept))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; It grants: it keeps as much or more, and tells the sender that or less.
(push)
(assert (and sends-grant sender-rests (= known2 known) (>= kept2 kept)
             (= (number new) known) (<= (flow new) kept2)))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If it may keep less than it did, the sender may use what is not kept any more.
(push)
(assert (and sends-grant sender-rests (= known2 known) (= (number new) known) (<= (flow new) kept2)))
(assert (not after))
(check-sat) ; expect sat
(pop)
; The sender takes in a grant that answers its last request, or not all of it.
(push)
(assert (and sends-nothing receiver-rests (was-grant heard) (= (number heard) asked)
             (= held2 held) (= asked2 asked) (>= granted2 granted)
             (<= granted2 (ite (> (flow heard) granted) (flow heard) granted))))
(assert (not after))
(check-sat) ; expect unsat
(pop)
; If the numbers are not compared, a late grant is for something that is not kept any more.
(push)
(assert (and sends-nothing receiver-rests (was-grant heard)
             (= held2 held) (= asked2 asked) (= granted2 (ite (> (flow heard) granted) (flow heard) granted))))
(assert (not after))
(check-sat) ; expect sat
(pop)

; A robot that lowers its flows by at most what it has to spare, and grants at most that, keeps
; c = (flows out) − (granted to others) − r ≥ 0.
(declare-const out Real) (declare-const given Real) (declare-const rate Real)
(declare-const out2 Real) (declare-const given2 Real)
(define-fun spare () Real (- (- out given) rate))
(assert (>= spare 0.0))
(push)
(assert (or (and (>= out2 (- out spare)) (= given2 given))
            (and (= out2 out) (<= given2 (+ given spare)))))
(assert (< (- (- out2 given2) rate) 0.0))
(check-sat) ; expect unsat
(pop)
(push)
(assert (and (< out2 (- out spare)) (= given2 given) (< (- (- out2 given2) rate) 0.0)))
(check-sat) ; expect sat
(pop)

; So it is in the control periods ahead, if no grant is renewed: what is given ends after `first` in part and
; after `last` altogether, and of two flows (one with a part is two) a lasts until `end-a` and b until `end-b`.
; What is carried in these two periods is carried up to the last.
(declare-const a Real) (declare-const b Real) (declare-const end-a Int) (declare-const end-b Int)
(declare-const all Real) (declare-const part Real) (declare-const first Int) (declare-const last Int)
(declare-const now Int)
(define-fun lasting ((period Int)) Real (+ (ite (<= period end-a) a 0.0) (ite (<= period end-b) b 0.0)))
(define-fun promised ((period Int)) Real (ite (<= period first) all (ite (<= period last) part 0.0)))
(define-fun carried ((period Int)) Bool (>= (lasting period) (+ (promised period) rate)))
(assert (and (>= a 0.0) (>= b 0.0) (>= part 0.0) (>= all part) (>= rate 0.0) (<= first last)))
(push)
(assert (and (carried first) (carried last) (<= now last) (not (carried now))))
(check-sat) ; expect unsat
(pop)
; What is carried only now need not be carried at the last period.
(push)
(assert (and (carried now) (< now last) (not (carried last))))
(check-sat) ; expect sat
(pop)

; The first robot sends `there` to the second, which sends `back` no more than that; so much is granted. Each has granted others something, too, and
; sends to others. What goes there beyond what comes back is carried by what the second robot sends to others, and is
; enough for the first one.
(declare-const there Real) (declare-const back Real)
(declare-const on1 Real) (declare-const on2 Real) (declare-const others1 Real) (declare-const others2 Real)
(declare-const rate1 Real) (declare-const rate2 Real)
(assert (and (>= back 0.0) (>= there back)))
(assert (>= (- (+ there on1) (+ back others1)) rate1))
(assert (>= (- (+ back on2) (+ there others2)) rate2))
(push)
(assert (not (and (>= (- on2 (+ (- there back) others2)) rate2)
                  (>= (- (+ (- there back) on1) others1) rate1))))
(check-sat) ; expect unsat
(pop)
; All that goes there need not be carried by that.
(assert (< (- on2 (+ there others2)) rate2))
(check-sat) ; expect sat
