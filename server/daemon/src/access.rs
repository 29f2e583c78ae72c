//! Who may do what. Tokens have roles; the table says what each role may; the roster knows who is who.
//!
//! It must never stand between anybody and the stop.

mod role;
mod roster;
pub mod table;
mod token;

pub use role::Role;
pub use roster::{Caller, Change, Holder, NotLetIn, Roster, SignedIn, Standing, TICKET_LASTS};
pub use table::Who;
pub use token::Token;
