//! Who may do what. Tokens have roles; the table says what each role may; the roster knows who is who.
//!
//! It must never stand between anybody and the stop.

mod role;
mod token;

pub use role::Role;
pub use token::Token;
