//! Expressions with kinks, as smooth ones that each hold on one side of every kink.
//!
//! Absolute values, signs, floors, minima, maxima, angles, choices and tables have kinks or jumps. Between
//! them they are smooth: |x| is x or −x, and a table of lines is one of its lines. [`Sides`]
//! compiles expressions to a form in which numbers beside the variables say on which *side* of each
//! kink they are taken, also where the state is beyond it, and with it the predicate that some kink
//! has been *passed*: that the state is on another side. A solver of differential equations follows
//! the smooth form until that predicate holds, and then chooses the sides anew.

use std::convert::Infallible;
use std::f64::consts::PI;
use std::sync::Arc;

use crate::course::Tracker;
use crate::expression::{BinaryOperator, Choice, Expression, UnaryOperator, constant, variable};
use crate::fold::Operands;
use crate::predicate::{Comparison, Predicate};
use crate::program::{CompiledPredicate, Program};
use crate::table::{Interpolation, Table};
use crate::tape::Tape;
use crate::valuation::EvaluationError;

/// Expressions compiled by [`Sides::compile`] to smooth ones.
///
/// On the sides of a state they have the values of the expressions, but for the signs of zeros and the last
/// digits of angles and on the lines of tables. Beyond a kink, and on a line of a table at an infinite place,
/// they may have none.
///
/// ```
/// use pleach_guards::{Sides, variable};
///
/// let x = variable("x");
/// let sides = Sides::compile([&x.abs()], &["x"])?.expect("|x| has a kink");
/// let mut places = sides.smooth().places();
/// let mut result = [0.0];
///
/// // x, and the side of its kink.
/// let mut values = [-2.0, 0.0];
/// sides.choose(&mut values);
/// sides.smooth().evaluate(&values, &mut places, &mut result);
/// assert_eq!(result, [2.0]);
///
/// // The same side goes on beyond the kink, where |x| has another one.
/// values[0] = 1.0;
/// sides.smooth().evaluate(&values, &mut places, &mut result);
/// assert_eq!(result, [-1.0]);
/// assert!(sides.passed().evaluate(&values)?.holds);
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sides {
    variables: usize,
    smooth: Tape,
    /// In an order in which each depends on those before it alone.
    kinks: Box<[Kink]>,
    count: usize,
    passed: CompiledPredicate,
    tracker: Tracker,
    /// Where an expression may jump; none if all are continuous.
    jumps: Option<Tracker>,
}

/// A part of an expression that has kinks, over the variables and the sides of other kinks.
#[derive(Clone, Debug)]
struct Kink {
    source: Expression,
    /// Its operands, or the sides of its condition.
    operands: Box<[Program]>,
    /// The place of its first number among those of the sides.
    first: usize,
}

/// What stands for an operand where no choice leads to the kink: no kink is there.
const ELSEWHERE: f64 = 0.5;

impl Sides {
    /// The smooth form of these expressions, on slices in which place *i* holds the value of
    /// `variables[i]`; none if they have no kinks.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if a variable of an expression is not listed.
    pub fn compile<'e>(
        expressions: impl IntoIterator<Item = &'e Expression>,
        variables: &[impl AsRef<str>],
    ) -> Result<Option<Sides>, EvaluationError> {
        let expressions: Vec<&Expression> = expressions.into_iter().collect();
        if !expressions.iter().any(|expression| expression.parts().any(Expression::has_kinks)) {
            return Ok(None);
        }
        let mut drafts = Drafts::default();
        let smooth: Vec<Draft> = expressions.iter().map(|one| drafts.smoothed(one)).collect();
        let order = smooth.iter().flat_map(|draft| draft.order.iter().copied());
        let mut names: Vec<String> =
            variables.iter().map(|name| name.as_ref().to_owned()).collect();
        names.extend((0..drafts.count).map(name_of));
        let kink = |number: usize| -> Result<Kink, EvaluationError> {
            let Part { source, operands, first } = &drafts.parts[number];
            let operands = operands.iter().map(|operand| operand.compile(&names));
            Ok(Kink {
                source: source.clone(),
                operands: operands.collect::<Result<_, _>>()?,
                first: *first,
            })
        };
        let passed = Predicate::any(drafts.parts.iter().map(Part::passed));
        let jumps: Vec<Predicate> = drafts.parts.iter().filter_map(Part::jumped).collect();
        let jumps = (!jumps.is_empty()).then(|| Predicate::any(jumps).track(&names));
        Ok(Some(Sides {
            variables: variables.len(),
            smooth: Tape::compile(smooth.iter().map(|draft| &draft.smooth), &names)?,
            kinks: order.map(kink).collect::<Result<_, _>>()?,
            count: drafts.count,
            passed: passed.compile(&names)?,
            tracker: passed.track(&names)?,
            jumps: jumps.transpose()?,
        }))
    }

    /// How many numbers say which sides.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How many parts have kinks.
    pub fn kinks(&self) -> usize {
        self.kinks.len()
    }

    /// The smooth expressions, on slices of the variables, followed by the sides.
    pub fn smooth(&self) -> &Tape {
        &self.smooth
    }

    /// Holds where the state is beyond a kink, on another side than the one that is chosen.
    pub fn passed(&self) -> &CompiledPredicate {
        &self.passed
    }

    /// The same, to be followed over time.
    pub fn tracker(&self) -> &Tracker {
        &self.tracker
    }

    /// Holds where the state is beyond a kink at which an expression may jump; none if all are continuous.
    pub fn jumps(&self) -> Option<&Tracker> {
        self.jumps.as_ref()
    }

    /// Writes the sides that hold where the variables are, after these in the same slice; the first part
    /// with a kink that has another side than before, if there is one.
    pub fn choose(&self, values: &mut [f64]) -> Option<&Expression> {
        let mut changed = None;
        for kink in &self.kinks {
            let first = self.variables + kink.first;
            let before = values[first];
            kink.choose(values, first);
            let is_same = values[first] == before || values[first].is_nan() && before.is_nan();
            if !is_same && changed.is_none() {
                changed = Some(&kink.source);
            }
        }
        changed
    }
}

impl Kink {
    /// Writes the numbers of its side from `first` on.
    fn choose(&self, values: &mut [f64], first: usize) {
        let at = |number: usize| self.operands[number].evaluate(values);
        match &self.source {
            Expression::Unary(UnaryOperator::AbsoluteValue, _) => {
                values[first] = if at(0) < 0.0 { -1.0 } else { 1.0 };
            }
            Expression::Unary(UnaryOperator::Sign, _) => {
                values[first] = UnaryOperator::Sign.apply(at(0));
            }
            Expression::Unary(..) => values[first] = at(0).floor(),
            Expression::Binary(BinaryOperator::Angle, ..) => {
                values[first] = if at(1) < 0.0 { 1f64.copysign(at(0)) } else { 0.0 };
            }
            Expression::Binary(BinaryOperator::Minimum, ..) => {
                values[first] = if at(0) > at(1) { -1.0 } else { 1.0 };
            }
            Expression::Binary(..) => values[first] = if at(0) < at(1) { -1.0 } else { 1.0 },
            Expression::Choice(choice) => {
                let holds = choice.condition.relation.judge(at(0), at(1)).holds;
                values[first] = f64::from(u8::from(holds));
            }
            Expression::Lookup(table, _) => {
                let line = table.line_at(at(0));
                values[first..first + LINE].copy_from_slice(&line);
            }
            _ => {}
        }
    }
}

/// How many numbers say which line of a table it is: from where to where it counts, and its place, value
/// and slope.
const LINE: usize = 5;

impl Table {
    /// The line or step that counts at `place`.
    fn line_at(&self, place: f64) -> [f64; LINE] {
        let points = self.points();
        let after = points.partition_point(|point| point.0 <= place);
        let next = points.get(after);
        let to = next.map_or(f64::INFINITY, |point| point.0);
        let Some(&(from, value)) = after.checked_sub(1).and_then(|before| points.get(before))
        else {
            return [f64::NEG_INFINITY, to, points[0].0, points[0].1, 0.0];
        };
        let slope = match next {
            Some(&(to, end)) if self.interpolation() == Interpolation::Linear => {
                (end - value) / (to - from)
            }
            _ => 0.0,
        };
        [from, to, from, value, slope]
    }
}

/// The name of a number of the sides; no name that a person gives begins like this.
fn name_of(number: usize) -> String {
    format!("\u{1}{number}")
}

fn side(number: usize) -> Expression {
    variable(&name_of(number))
}

impl Expression {
    /// Whether the part has kinks itself.
    fn has_kinks(&self) -> bool {
        match self {
            Expression::Unary(operator, _) => matches!(
                operator,
                UnaryOperator::AbsoluteValue | UnaryOperator::Sign | UnaryOperator::Floor
            ),
            Expression::Binary(operator, ..) => {
                use BinaryOperator::{Angle, Maximum, Minimum};
                matches!(operator, Minimum | Maximum | Angle)
            }
            Expression::Lookup(table, _) => table.interpolation() != Interpolation::Flat,
            Expression::Choice(_) => true,
            _ => false,
        }
    }
}

/// Kinks that have been found.
#[derive(Default)]
struct Drafts {
    parts: Vec<Part>,
    count: usize,
}

/// A kink that has been found.
struct Part {
    source: Expression,
    operands: Vec<Expression>,
    first: usize,
}

/// The smooth form of an expression, and the order in which the sides of its kinks are chosen.
struct Draft {
    smooth: Expression,
    order: Vec<usize>,
}

impl Drafts {
    fn smoothed(&mut self, expression: &Expression) -> Draft {
        let Ok(draft) =
            expression.fold(&mut |part, operands| Ok::<_, Infallible>(self.part(part, operands)));
        draft
    }

    fn part(&mut self, part: &Expression, operands: Operands<Draft>) -> Draft {
        let mut order = Vec::new();
        let smooth = |draft: Draft| {
            order.extend(draft.order);
            draft.smooth
        };
        let operands = match operands {
            Operands::Four(parts) => return self.choice(part, parts),
            operands if !part.has_kinks() => {
                let smooth = part.with_operands(operands.map(smooth));
                return Draft { smooth, order };
            }
            Operands::One(operand) => [operand].map(smooth).to_vec(),
            Operands::Two(left, right) => [left, right].map(smooth).to_vec(),
            Operands::None => Vec::new(),
        };
        let smooth = match part {
            Expression::Unary(UnaryOperator::AbsoluteValue, _) => {
                side(self.count) * operands[0].clone()
            }
            Expression::Unary(..) => side(self.count),
            // On the left the angle of the opposite point, from where it is half a turn away.
            Expression::Binary(BinaryOperator::Angle, ..) => {
                let own = side(self.count);
                let turned = 1.0 - 2.0 * own.abs();
                let [y, x] = [0, 1].map(|number| turned.clone() * operands[number].clone());
                y.atan2(x) + PI * own
            }
            Expression::Lookup(..) => {
                let [place, value, slope] = [2, 3, 4].map(|number| side(self.count + number));
                value + slope * (operands[0].clone() - place)
            }
            _ => chosen(self.count, operands[0].clone(), operands[1].clone()),
        };
        order.push(self.add(part, operands));
        Draft { smooth, order }
    }

    /// Kinks in what a choice leaves out do not count.
    fn choice(&mut self, part: &Expression, [left, right, then, otherwise]: [Draft; 4]) -> Draft {
        let first = self.count;
        let smooth = chosen(first, then.smooth, otherwise.smooth);
        for (inner, is_then) in [(&then.order, true), (&otherwise.order, false)] {
            for &number in inner {
                for operand in &mut self.parts[number].operands {
                    let (here, elsewhere) = (operand.clone(), constant(ELSEWHERE));
                    *operand = match is_then {
                        true => chosen(first, here, elsewhere),
                        false => chosen(first, elsewhere, here),
                    };
                }
            }
        }
        let mut order = [left.order, right.order].concat();
        order.push(self.add(part, vec![left.smooth, right.smooth]));
        order.extend([then.order, otherwise.order].concat());
        Draft { smooth, order }
    }

    fn add(&mut self, part: &Expression, operands: Vec<Expression>) -> usize {
        let first = self.count;
        self.count += if matches!(part, Expression::Lookup(..)) { LINE } else { 1 };
        self.parts.push(Part { source: part.clone(), operands, first });
        self.parts.len() - 1
    }
}

/// `then` where the number of this side is positive.
fn chosen(number: usize, then: Expression, otherwise: Expression) -> Expression {
    let Predicate::Comparison(condition) = side(number).more_than(0.0) else { return then };
    Expression::Choice(Arc::new(Choice { condition, then, otherwise }))
}

impl Part {
    /// Holds where another side counts, if the part may jump there. A sign of 0 is left by any motion.
    fn jumped(&self) -> Option<Predicate> {
        match &self.source {
            Expression::Unary(UnaryOperator::AbsoluteValue, _)
            | Expression::Binary(BinaryOperator::Minimum | BinaryOperator::Maximum, ..) => None,
            Expression::Unary(UnaryOperator::Sign, _)
            | Expression::Binary(BinaryOperator::Angle, ..) => {
                Some((side(self.first) * &self.operands[0]).less_than(0.0))
            }
            Expression::Lookup(table, _) if table.interpolation() == Interpolation::Linear => None,
            _ => Some(self.passed()),
        }
    }

    /// Holds where another side counts.
    fn passed(&self) -> Predicate {
        let (own, operand) = (side(self.first), &self.operands[0]);
        match &self.source {
            Expression::Unary(UnaryOperator::AbsoluteValue, _) => (own * operand).less_than(0.0),
            Expression::Unary(UnaryOperator::Sign, _) => {
                let moves = operand.less_than(0.0) | operand.more_than(0.0);
                (&own * operand).less_than(0.0) | own.abs().at_most(0.0) & moves
            }
            Expression::Unary(..) => {
                let above = operand - own;
                above.less_than(0.0) | above.at_least(1.0)
            }
            Expression::Binary(BinaryOperator::Angle, ..) => {
                let x = &self.operands[1];
                let left = x.more_than(0.0) | (&own * operand).less_than(0.0);
                own.abs().at_most(0.0) & x.less_than(0.0) | own.abs().more_than(0.0) & left
            }
            Expression::Binary(BinaryOperator::Minimum, ..) => {
                (own * (operand - &self.operands[1])).more_than(0.0)
            }
            Expression::Binary(..) => (own * (operand - &self.operands[1])).less_than(0.0),
            Expression::Choice(choice) => {
                let condition = Predicate::Comparison(Comparison {
                    left: operand.clone(),
                    relation: choice.condition.relation,
                    right: self.operands[1].clone(),
                });
                own.more_than(0.0) & !condition.clone() | own.at_most(0.0) & condition
            }
            _ => operand.less_than(own) | operand.at_least(side(self.first + 1)),
        }
    }
}
