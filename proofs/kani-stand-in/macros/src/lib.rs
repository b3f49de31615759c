//! The attributes of Kani, for the stable toolchain: a harness becomes a test.

use proc_macro::{Delimiter, Group, Ident, Literal, Span, TokenStream, TokenTree};

/// Makes a harness a test that runs its body on concrete values (`kani::run`).
///
/// The body is handed over together with the number of times it says `cover!`, so that a
/// cover that no case ever reaches is missed, too.
#[proc_macro_attribute]
pub fn proof(_arguments: TokenStream, harness: TokenStream) -> TokenStream {
    let mut tokens: Vec<TokenTree> = harness.into_iter().collect();
    let Some(TokenTree::Group(body)) = tokens.pop() else {
        return refuse("#[kani::proof] stands before a function with a body");
    };
    let Some(name) = name(&tokens) else {
        return refuse("#[kani::proof] stands before a function");
    };
    let covers = count(&body.stream(), "cover");
    let arguments: TokenStream = [
        TokenTree::Literal(Literal::string(&name)),
        comma(),
        TokenTree::Literal(Literal::usize_unsuffixed(covers)),
        comma(),
        punct('|'),
        punct('|'),
        TokenTree::Group(body),
    ]
    .into_iter()
    .collect();
    let mut call: TokenStream = path("kani", "run");
    call.extend([TokenTree::Group(Group::new(Delimiter::Parenthesis, arguments))]);
    tokens.push(TokenTree::Group(Group::new(Delimiter::Brace, call)));
    // Outside of tests a harness is only type-checked, and never called.
    let mut test: TokenStream = attribute("cfg_attr", "(test, test)");
    test.extend(attribute("cfg_attr", "(not(test), allow(dead_code))"));
    test.extend(tokens);
    test
}

/// How often Kani unrolls loops; running needs no bound.
#[proc_macro_attribute]
pub fn unwind(_times: TokenStream, harness: TokenStream) -> TokenStream {
    harness
}

/// The solver that Kani is to use; running needs none.
#[proc_macro_attribute]
pub fn solver(_name: TokenStream, harness: TokenStream) -> TokenStream {
    harness
}

/// The word behind `fn`.
fn name(tokens: &[TokenTree]) -> Option<String> {
    let function = tokens.iter().position(|token| token.to_string() == "fn")?;
    tokens.get(function + 1).map(ToString::to_string)
}

/// How often `word!` occurs, also within groups.
fn count(stream: &TokenStream, word: &str) -> usize {
    let tokens: Vec<TokenTree> = stream.clone().into_iter().collect();
    let here = tokens
        .windows(2)
        .filter(|pair| pair[0].to_string() == word && pair[1].to_string() == "!")
        .count();
    let within = tokens.iter().map(|token| match token {
        TokenTree::Group(group) => count(&group.stream(), word),
        _ => 0,
    });
    here + within.sum::<usize>()
}

fn comma() -> TokenTree {
    punct(',')
}

fn punct(character: char) -> TokenTree {
    TokenTree::Punct(proc_macro::Punct::new(character, proc_macro::Spacing::Alone))
}

fn path(library: &str, function: &str) -> TokenStream {
    let joint = || TokenTree::Punct(proc_macro::Punct::new(':', proc_macro::Spacing::Joint));
    let word = |word| TokenTree::Ident(Ident::new(word, Span::call_site()));
    [joint(), punct(':'), word(library), joint(), punct(':'), word(function)].into_iter().collect()
}

fn attribute(name: &str, arguments: &str) -> TokenStream {
    format!("#[{name}{arguments}]").parse().unwrap_or_default()
}

fn refuse(reason: &str) -> TokenStream {
    format!("compile_error!({reason:?});").parse().unwrap_or_default()
}
