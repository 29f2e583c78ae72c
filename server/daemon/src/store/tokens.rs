//! Tokens and logins. Nothing secret is stored: hashes alone.

use super::{Store, StoreError};
use crate::access::Role;

/// A token as it is stored. Moments are RFC 3339.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredToken {
    /// The public part of the token.
    pub id: String,
    /// What its holder is called.
    pub name: String,
    /// What its holder may do.
    pub role: Role,
    /// Of its secret.
    pub hash: String,
    /// When it was made.
    pub created: String,
    /// When it ends by itself; none: never.
    pub expires: Option<String>,
    /// When it was taken back.
    pub revoked: Option<String>,
}

/// Somebody signed in by a browser. Moments are RFC 3339.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredLogin {
    /// SHA-256 of the cookie, in hexadecimal digits.
    pub hash: String,
    /// The token that they signed in with.
    pub token_id: String,
    /// When it ends by itself.
    pub expires: String,
}

impl Store {
    /// Store a token; false when another one of its name is in use.
    pub async fn add_token(&self, token: &StoredToken) -> Result<bool, StoreError> {
        let added = sqlx::query(
            "INSERT INTO tokens (id, name, role, hash, created, expires) VALUES (?, ?, ?, ?, ?, ?) \
             ON CONFLICT DO NOTHING",
        )
        .bind(&token.id)
        .bind(&token.name)
        .bind(token.role.name())
        .bind(&token.hash)
        .bind(&token.created)
        .bind(&token.expires)
        .execute(&self.pool)
        .await?;
        Ok(added.rows_affected() == 1)
    }

    /// Every token that there ever was, oldest first.
    pub async fn tokens(&self) -> Result<Vec<StoredToken>, StoreError> {
        let rows: Vec<TokenRow> = sqlx::query_as(
            "SELECT id, name, role, hash, created, expires, revoked FROM tokens ORDER BY created, id",
        )
        .fetch_all(&self.pool)
        .await?;
        let token = |(id, name, role, hash, created, expires, revoked): TokenRow| {
            let role = Role::parse(&role)
                .ok_or_else(|| sqlx::Error::Decode(format!("tokens.role of {id}: found {role}").into()))?;
            Ok(StoredToken { id, name, role, hash, created, expires, revoked })
        };
        rows.into_iter().map(token).collect()
    }

    /// Take back the token of this id or name, with all logins of it; the token, or none when there is no such
    /// token in use.
    pub async fn revoke_token(&self, which: &str, at: &str) -> Result<Option<StoredToken>, StoreError> {
        let mut transaction = self.pool.begin_with("BEGIN IMMEDIATE").await?;
        let revoked: Option<(String,)> = sqlx::query_as(
            "UPDATE tokens SET revoked = ?1 WHERE (id = ?2 OR name = ?2) AND revoked IS NULL RETURNING id",
        )
        .bind(at)
        .bind(which)
        .fetch_optional(&mut *transaction)
        .await?;
        let Some((id,)) = revoked else { return Ok(None) };
        sqlx::query("DELETE FROM logins WHERE token_id = ?").bind(&id).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(self.tokens().await?.into_iter().find(|token| token.id == id))
    }

    /// Store a login, and forget those that ended before `now`.
    pub async fn add_login(&self, login: &StoredLogin, now: &str) -> Result<(), StoreError> {
        let mut transaction = self.pool.begin_with("BEGIN IMMEDIATE").await?;
        sqlx::query("DELETE FROM logins WHERE expires < ?").bind(now).execute(&mut *transaction).await?;
        sqlx::query("INSERT INTO logins (hash, token_id, created, expires) VALUES (?, ?, ?, ?)")
            .bind(&login.hash)
            .bind(&login.token_id)
            .bind(now)
            .bind(&login.expires)
            .execute(&mut *transaction)
            .await?;
        transaction.commit().await?;
        Ok(())
    }

    /// Every login.
    pub async fn logins(&self) -> Result<Vec<StoredLogin>, StoreError> {
        let rows: Vec<(String, String, String)> =
            sqlx::query_as("SELECT hash, token_id, expires FROM logins").fetch_all(&self.pool).await?;
        let login = |(hash, token_id, expires)| StoredLogin { hash, token_id, expires };
        Ok(rows.into_iter().map(login).collect())
    }

    /// Forget a login.
    pub async fn remove_login(&self, hash: &str) -> Result<(), StoreError> {
        sqlx::query("DELETE FROM logins WHERE hash = ?").bind(hash).execute(&self.pool).await?;
        Ok(())
    }
}

type TokenRow = (String, String, String, String, String, Option<String>, Option<String>);
