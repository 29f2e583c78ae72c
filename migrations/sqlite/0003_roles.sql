-- Who may do what. A token's secret is nowhere: its hash is (argon2, a PHC string).

CREATE TABLE tokens (
    id      TEXT PRIMARY KEY,
    name    TEXT NOT NULL,
    role    TEXT NOT NULL CHECK (role IN ('observer', 'client', 'designer', 'game_master', 'administrator')),
    hash    TEXT NOT NULL,
    created TEXT NOT NULL,
    expires TEXT,
    revoked TEXT
) STRICT, WITHOUT ROWID;

-- A name is free again once its token is revoked: the record still tells the two apart by their ids.
CREATE UNIQUE INDEX token_names ON tokens (name) WHERE revoked IS NULL;

-- Who is signed in by a browser: SHA-256 of the cookie, which is 256 random bits.
CREATE TABLE logins (
    hash     TEXT PRIMARY KEY,
    token_id TEXT NOT NULL REFERENCES tokens (id),
    created  TEXT NOT NULL,
    expires  TEXT NOT NULL
) STRICT, WITHOUT ROWID;
