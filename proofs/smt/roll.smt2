; No robot that takes part takes for gone another one that may move, whatever rolls they have heard.
;
; Rolls are numbered by the control period in which they are called, and valid for V periods. One of
; the robots goes by roll r, which lets it move, the other by roll s, which calls the first one gone,
; in the same period p. Between a roll that lets a robot move and one that calls it gone, in either
; order, are more than V periods: it is suspended meanwhile.
(set-logic QF_LIA)
(declare-const V Int)
(declare-const p Int)
(declare-const r Int)
(declare-const s Int)
(define-fun valid ((roll Int)) Bool (and (<= roll p) (<= p (+ roll V))))
(assert (and (> V 0) (valid r) (valid s)))
(push)
(assert (or (> (- r s) V) (> (- s r) V)))
(check-sat) ; expect unsat
(pop)
; If it is suspended for no longer than V periods it may meet one that does not expect it.
(assert (or (>= (- r s) V) (>= (- s r) V)))
(check-sat) ; expect sat
