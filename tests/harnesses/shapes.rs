//! Which values of a harness are arrays, and of how many bytes, as far as its file says.

use std::collections::BTreeMap;

use super::source::{Harness, text_of};

/// What a value is when two of its kind are compared.
#[derive(Clone)]
pub enum Shape {
    /// A whole number or truth value of this many bytes.
    Bytes(usize),
    Array(Box<Shape>, usize),
    /// A number with a fractional part, or an enum or struct of the project.
    Other,
    Unknown,
}

impl Shape {
    /// Turns of the loop that compares two of them: one for each byte of arrays of whole numbers, and one for each
    /// element of others. What is not known may be as large as a word.
    pub fn turns(&self) -> usize {
        match self {
            Shape::Array(element, count) => match **element {
                Shape::Bytes(bytes) => count.saturating_mul(bytes),
                Shape::Array(..) => count.saturating_mul(element.turns()),
                Shape::Other => *count,
                Shape::Unknown => count.saturating_mul(size_of::<usize>()),
            },
            _ => 0,
        }
    }
}

/// What is known of the names in a harness.
pub struct Shapes<'a> {
    items: &'a [syn::Item],
    /// Constants of the file and of the harness.
    numbers: BTreeMap<String, usize>,
    locals: BTreeMap<String, Shape>,
}

impl<'a> Shapes<'a> {
    pub fn new(harness: &'a Harness) -> Self {
        let (numbers, locals) = (BTreeMap::new(), BTreeMap::new());
        let mut shapes = Shapes { items: &harness.items, numbers, locals };
        for item in harness.items.iter() {
            if let syn::Item::Const(constant) = item {
                shapes.note_constant(constant);
            }
        }
        shapes
    }

    pub fn note_constant(&mut self, constant: &syn::ItemConst) {
        if let Some(number) = self.number(&constant.expr) {
            self.numbers.insert(constant.ident.to_string(), number);
        }
    }

    pub fn shape(&self, value: &syn::Expr) -> Shape {
        match value {
            syn::Expr::Array(it) => {
                let element = it.elems.first().map_or(Shape::Unknown, |first| self.shape(first));
                Shape::Array(Box::new(element), it.elems.len())
            }
            syn::Expr::Repeat(it) => self.array(self.shape(&it.expr), &it.len),
            syn::Expr::Path(it) => {
                let name = text_of(it);
                self.locals
                    .get(&name)
                    .cloned()
                    .or_else(|| self.type_of(&name))
                    .unwrap_or(Shape::Unknown)
            }
            syn::Expr::Call(it) => self.type_of(&text_of(&*it.func)).unwrap_or(Shape::Unknown),
            syn::Expr::MethodCall(it) if it.method == "clone" => self.shape(&it.receiver),
            syn::Expr::Reference(it) => self.shape(&it.expr),
            syn::Expr::Paren(it) => self.shape(&it.expr),
            syn::Expr::Cast(it) => self.shape_of_type(&it.ty),
            syn::Expr::Index(it) if !matches!(*it.index, syn::Expr::Range(_)) => {
                match self.shape(&it.expr) {
                    Shape::Array(element, _) => *element,
                    _ => Shape::Unknown,
                }
            }
            syn::Expr::Lit(it) => match &it.lit {
                syn::Lit::Bool(_) => Shape::Bytes(1),
                syn::Lit::Float(_) => Shape::Other,
                syn::Lit::Int(it) => bytes_of(it.suffix()).map_or(Shape::Unknown, Shape::Bytes),
                _ => Shape::Unknown,
            },
            _ => Shape::Unknown,
        }
    }

    /// An array, which may be of any length if that is not known.
    fn array(&self, element: Shape, length: &syn::Expr) -> Shape {
        Shape::Array(Box::new(element), self.number(length).unwrap_or(usize::MAX))
    }

    /// Whether a loop over this has a turn in any case.
    pub fn is_never_empty(&self, through: &syn::Expr) -> bool {
        match through {
            syn::Expr::Range(it) => match (it.start.as_deref(), it.end.as_deref()) {
                (Some(start), Some(end)) => {
                    self.number(start).is_some_and(|it| Some(it) < self.number(end))
                }
                _ => false,
            },
            syn::Expr::MethodCall(it) => {
                let goes_on = ["iter", "iter_mut", "enumerate", "zip", "take"];
                goes_on.iter().any(|name| it.method == name) && self.is_never_empty(&it.receiver)
            }
            syn::Expr::Paren(it) => self.is_never_empty(&it.expr),
            _ => matches!(self.shape(through), Shape::Array(_, 1..)),
        }
    }

    /// What a function of the file returns, or a constant is.
    fn type_of(&self, name: &str) -> Option<Shape> {
        self.items.iter().find_map(|item| match item {
            syn::Item::Const(it) if it.ident == name => Some(self.shape_of_type(&it.ty)),
            syn::Item::Fn(it) if it.sig.ident == name => match &it.sig.output {
                syn::ReturnType::Type(_, returned) => Some(self.shape_of_type(returned)),
                syn::ReturnType::Default => None,
            },
            _ => None,
        })
    }

    fn shape_of_type(&self, of: &syn::Type) -> Shape {
        match of {
            syn::Type::Array(it) => self.array(self.shape_of_type(&it.elem), &it.len),
            syn::Type::Reference(it) => self.shape_of_type(&it.elem),
            syn::Type::Path(it) => bytes_of(&text_of(it)).map_or(Shape::Other, Shape::Bytes),
            _ => Shape::Unknown,
        }
    }

    /// A number that is written out, or a constant of the file.
    fn number(&self, value: &syn::Expr) -> Option<usize> {
        match value {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(it), .. }) => it.base10_parse().ok(),
            syn::Expr::Path(it) => self.numbers.get(&text_of(it)).copied(),
            syn::Expr::MethodCall(it) if it.method == "len" => match self.shape(&it.receiver) {
                Shape::Array(_, length) => Some(length),
                _ => None,
            },
            syn::Expr::Binary(it) => {
                let (left, right) = (self.number(&it.left)?, self.number(&it.right)?);
                match it.op {
                    syn::BinOp::Add(_) => left.checked_add(right),
                    syn::BinOp::Sub(_) => left.checked_sub(right),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// A name is bound to a value.
    pub fn bind(&mut self, pattern: &syn::Pat, value: Option<&syn::Expr>) {
        match (pattern, value) {
            (syn::Pat::Ident(it), Some(value)) => {
                let shape = self.shape(value);
                self.locals.insert(it.ident.to_string(), shape);
            }
            (syn::Pat::Tuple(names), Some(syn::Expr::Tuple(values))) => {
                for (name, value) in names.elems.iter().zip(&values.elems) {
                    self.bind(name, Some(value));
                }
            }
            (syn::Pat::Type(it), _) => self.bind_as(&it.pat, &it.ty),
            _ => {}
        }
    }

    fn bind_as(&mut self, pattern: &syn::Pat, of: &syn::Type) {
        match (pattern, of) {
            (syn::Pat::Ident(it), of) => {
                let shape = self.shape_of_type(of);
                self.locals.insert(it.ident.to_string(), shape);
            }
            (syn::Pat::Tuple(names), syn::Type::Tuple(types)) => {
                for (name, of) in names.elems.iter().zip(&types.elems) {
                    self.bind_as(name, of);
                }
            }
            _ => {}
        }
    }
}

fn bytes_of(integer: &str) -> Option<usize> {
    Some(match integer {
        "bool" | "u8" | "i8" => 1,
        "u16" | "i16" => 2,
        "u32" | "i32" => 4,
        "u64" | "i64" | "usize" | "isize" => 8,
        _ => return None,
    })
}
