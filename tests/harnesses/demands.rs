//! What the model checker refuses, or passes over in silence, and does not show when harnesses run on values.
//!
//! It proves an assertion that no case reaches, so that each branch has a cover; it counts the turns of loops in the
//! standard library, which compares arrays byte by byte.

use syn::parse::Parser;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use super::shapes::Shapes;
use super::source::{Harness, text_of};

/// What is wrong with a harness, one line each.
pub fn complaints(harness: &Harness) -> Vec<String> {
    let mut reader = Reader::new(harness);
    reader.visit_block(&harness.body);
    let Reader { uncovered_assumption, mut complaints, .. } = reader;
    if let Some(line) = uncovered_assumption {
        complaints.push(format!("line {line}: no cover follows the assumption"));
    }
    for item in harness.items.iter() {
        if let syn::Item::Fn(function) = item
            && ["assert!", "cover!"].iter().any(|call| text_of(function).contains(call))
        {
            let name = &function.sig.ident;
            complaints.push(format!("`{name}` asserts or covers: harnesses do that themselves"));
        }
    }
    let (file, name) = (&harness.file, &harness.name);
    complaints.iter().map(|complaint| format!("{file}: `{name}`: {complaint}")).collect()
}

struct Reader<'a> {
    unwind: usize,
    shapes: Shapes<'a>,
    /// The line of an assumption that no cover has followed yet.
    uncovered_assumption: Option<usize>,
    complaints: Vec<String>,
}

impl<'a> Reader<'a> {
    fn new(harness: &'a Harness) -> Self {
        Reader {
            unwind: harness.unwind,
            shapes: Shapes::new(harness),
            uncovered_assumption: None,
            complaints: Vec::new(),
        }
    }

    fn complain(&mut self, part: &impl Spanned, what: &str) {
        let line = part.span().start().line;
        self.complaints.push(format!("line {line}: {what}"));
    }

    /// A branch does something, and does not only choose a value: some case must be seen to reach it.
    fn enter_branch(&mut self, branch: &syn::Block) {
        let chooses = match &branch.stmts[..] {
            [] => true,
            [syn::Stmt::Expr(value, None)] => !matches!(value, syn::Expr::Macro(_)),
            _ => false,
        };
        if !chooses && !branch.stmts.iter().any(is_cover) {
            self.complain(branch, "a branch without a cover");
        }
    }
}

fn is_cover(statement: &syn::Stmt) -> bool {
    matches!(statement, syn::Stmt::Macro(it) if is_called(&it.mac.path, "cover"))
}

fn is_called(path: &syn::Path, name: &str) -> bool {
    path.segments.last().is_some_and(|it| it.ident == name)
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_local(&mut self, local: &'ast syn::Local) {
        self.shapes.bind(&local.pat, local.init.as_ref().map(|init| &*init.expr));
        visit::visit_local(self, local);
    }

    fn visit_item_const(&mut self, constant: &'ast syn::ItemConst) {
        self.shapes.note_constant(constant);
    }

    fn visit_expr_if(&mut self, branch: &'ast syn::ExprIf) {
        self.enter_branch(&branch.then_branch);
        if let Some((_, other)) = &branch.else_branch
            && let syn::Expr::Block(other) = &**other
        {
            self.enter_branch(&other.block);
        }
        visit::visit_expr_if(self, branch);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        match &*arm.body {
            syn::Expr::Block(it) => self.enter_branch(&it.block),
            syn::Expr::Macro(_) => self.complain(arm, "a branch without a cover"),
            _ => {}
        }
        visit::visit_arm(self, arm);
    }

    fn visit_expr_while(&mut self, repeated: &'ast syn::ExprWhile) {
        self.enter_branch(&repeated.body);
        visit::visit_expr_while(self, repeated);
    }

    /// What a loop goes through may be empty, unless it is a range, an array or a loop over the places of one.
    fn visit_expr_for_loop(&mut self, repeated: &'ast syn::ExprForLoop) {
        let asserts = |statement: &syn::Stmt| matches!(statement, syn::Stmt::Macro(it) if is_called(&it.mac.path, "assert"));
        if !self.shapes.is_never_empty(&repeated.expr) && repeated.body.stmts.iter().any(asserts) {
            self.enter_branch(&repeated.body);
        }
        visit::visit_expr_for_loop(self, repeated);
    }

    fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
        if matches!(&*call.func, syn::Expr::Path(it) if is_called(&it.path, "assume")) {
            self.uncovered_assumption = Some(call.span().start().line);
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        if matches!(binary.op, syn::BinOp::Eq(_) | syn::BinOp::Ne(_)) {
            let turns = |side| self.shapes.shape(side).turns();
            let turns = turns(&binary.left).max(turns(&binary.right));
            if turns >= self.unwind {
                let unwind = self.unwind;
                let what = format!("compares {turns} bytes of an array, with unwind({unwind})");
                self.complain(binary, &what);
            }
        }
        visit::visit_expr_binary(self, binary);
    }

    /// Assertions and covers are expressions, too.
    fn visit_macro(&mut self, called: &'ast syn::Macro) {
        let parser = Punctuated::<syn::Expr, syn::Token![,]>::parse_terminated;
        let Ok(arguments) = parser.parse2(called.tokens.clone()) else { return };
        if is_called(&called.path, "cover") {
            self.uncovered_assumption = None;
        }
        for argument in &arguments {
            Visit::visit_expr(self, argument);
        }
    }
}
