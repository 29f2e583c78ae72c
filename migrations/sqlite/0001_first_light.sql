-- Times are RFC 3339 in UTC. Documents and particulars are JSON.

CREATE TABLE scenes (
    id      INTEGER PRIMARY KEY AUTOINCREMENT,
    name    TEXT NOT NULL,
    created TEXT NOT NULL
) STRICT;

-- A scene is never changed: each edit is a new version.
CREATE TABLE scene_versions (
    scene_id INTEGER NOT NULL REFERENCES scenes (id),
    version  INTEGER NOT NULL CHECK (version >= 1),
    document TEXT NOT NULL,
    author   TEXT NOT NULL,
    created  TEXT NOT NULL,
    PRIMARY KEY (scene_id, version)
) STRICT, WITHOUT ROWID;

-- A session lasts from arming to disarming, a stop that latches, a fault or the end of the server.
CREATE TABLE sessions (
    id            INTEGER PRIMARY KEY AUTOINCREMENT,
    started       TEXT NOT NULL,
    ended         TEXT,
    how           TEXT CHECK (how IN ('disarmed', 'latched_stop', 'faulted', 'shutdown', 'interrupted')),
    scene_id      INTEGER NOT NULL,
    scene_version INTEGER NOT NULL,
    CHECK ((ended IS NULL) = (how IS NULL)),
    FOREIGN KEY (scene_id, scene_version) REFERENCES scene_versions (scene_id, version)
) STRICT;

CREATE TABLE events (
    id         INTEGER PRIMARY KEY AUTOINCREMENT,
    session_id INTEGER REFERENCES sessions (id),
    at_micros  INTEGER NOT NULL,
    at         TEXT NOT NULL,
    kind       TEXT NOT NULL,
    summary    TEXT NOT NULL,
    detail     TEXT NOT NULL
) STRICT;

CREATE INDEX events_by_session ON events (session_id, id);

CREATE TABLE prior_changes (
    id            INTEGER PRIMARY KEY AUTOINCREMENT,
    at            TEXT NOT NULL,
    author        TEXT NOT NULL,
    object        TEXT NOT NULL,
    from_prior    REAL NOT NULL,
    to_prior      REAL NOT NULL,
    scene_id      INTEGER NOT NULL,
    scene_version INTEGER NOT NULL,
    FOREIGN KEY (scene_id, scene_version) REFERENCES scene_versions (scene_id, version)
) STRICT;

CREATE INDEX prior_changes_by_scene ON prior_changes (scene_id, scene_version, id);

-- What the server must know at its next start: one row.
CREATE TABLE server_state (
    only_row             INTEGER PRIMARY KEY CHECK (only_row = 1),
    latched_because      TEXT,
    active_scene_id      INTEGER,
    active_scene_version INTEGER,
    -- Prior changes with a greater id belong to the present activation.
    priors_after         INTEGER NOT NULL DEFAULT 0,
    FOREIGN KEY (active_scene_id, active_scene_version) REFERENCES scene_versions (scene_id, version)
) STRICT;

INSERT INTO server_state (only_row) VALUES (1);
