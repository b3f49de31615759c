//! Mistakes of shape that do not compile. What the compiler says is in the `.stderr` files; after a
//! change of wording, `TRYBUILD=overwrite cargo test --test compile_fail` writes them anew.

#[test]
fn mistakes_of_shape_do_not_compile() {
    trybuild::TestCases::new().compile_fail("tests/compile_fail/*.rs");
}
