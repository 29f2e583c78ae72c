//! A token in clear: `covr_<id>_<secret>`. The id is public and finds the row; the secret is 256 random bits, shown
//! once and kept nowhere.

use std::fmt;

use argon2::Argon2;
use argon2::password_hash::phc::PasswordHash;
use argon2::password_hash::{PasswordHasher, PasswordVerifier};
use sha2::{Digest, Sha256};

/// A token with its secret.
#[derive(Clone, PartialEq, Eq)]
pub struct Token {
    id: String,
    secret: String,
}

/// SHA-256 of something that is 256 random bits itself, so that a fast hash is enough.
pub type Fingerprint = [u8; 32];

impl Token {
    /// A new token.
    pub fn new() -> Result<Self, getrandom::Error> {
        Ok(Self { id: hex(&random::<ID_BYTES>()?), secret: random_text()? })
    }

    /// Read a token; none when it is not of a token's form.
    pub fn parse(text: &str) -> Option<Self> {
        let (id, secret) = text.strip_prefix(PREFIX)?.split_once('_')?;
        let is_hex = |text: &str, bytes: usize| {
            text.len() == 2 * bytes && text.bytes().all(|b| b.is_ascii_digit() || (b'a'..=b'f').contains(&b))
        };
        (is_hex(id, ID_BYTES) && is_hex(secret, SECRET_BYTES))
            .then(|| Self { id: id.into(), secret: secret.into() })
    }

    /// The public part.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// What is stored of the secret: argon2id, a PHC string. Takes tens of milliseconds.
    pub fn hash(&self) -> Result<String, argon2::password_hash::Error> {
        Ok(Argon2::default().hash_password(self.secret.as_bytes())?.to_string())
    }

    /// Whether this is the token that the hash was made of. Takes tens of milliseconds.
    pub fn matches(&self, hash: &str) -> bool {
        PasswordHash::new(hash)
            .is_ok_and(|hash| Argon2::default().verify_password(self.secret.as_bytes(), &hash).is_ok())
    }

    /// To know a token again that was matched before.
    pub fn fingerprint(&self) -> Fingerprint {
        fingerprint(&self.secret)
    }
}

/// The token as its holder is shown it.
impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{PREFIX}{}_{}", self.id, self.secret)
    }
}

/// Without the secret: it belongs in no log.
impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Token").field("id", &self.id).finish_non_exhaustive()
    }
}

/// 256 random bits as text.
pub fn random_text() -> Result<String, getrandom::Error> {
    Ok(hex(&random::<SECRET_BYTES>()?))
}

/// What is kept of 256 random bits.
pub fn fingerprint(text: &str) -> Fingerprint {
    Sha256::digest(text).into()
}

/// Bytes as text.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn random<const N: usize>() -> Result<[u8; N], getrandom::Error> {
    let mut bytes = [0; N];
    getrandom::fill(&mut bytes)?;
    Ok(bytes)
}

const PREFIX: &str = "covr_";
const ID_BYTES: usize = 4;
const SECRET_BYTES: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_read_back_and_matches_its_own_hash_alone() {
        let (token, other) = (Token::new().unwrap(), Token::new().unwrap());
        let hash = token.hash().unwrap();
        assert_eq!(Token::parse(&token.to_string()), Some(token.clone()));
        assert!(hash.starts_with("$argon2id$") && !hash.contains(&token.secret));
        assert!(token.matches(&hash));
        assert!(!other.matches(&hash) && !token.matches("no hash"));
    }

    #[test]
    fn what_is_no_token_is_not_read_and_no_secret_is_printed() {
        let token = Token::new().unwrap();
        let text = token.to_string();
        for bad in ["", "covr_", "covr_00000000_", &text[1..], &text[..text.len() - 1], &text.to_uppercase()]
        {
            assert_eq!(Token::parse(bad), None, "{bad}");
        }
        assert!(!format!("{token:?}").contains(&token.secret));
    }
}
