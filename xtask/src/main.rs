//! Developer and user commands of Overhear.

fn main() {}
