-- What a session was about, counted as it happens, and its recording.

-- Server time of start and end, as events and frames have it; null for sessions of before.
ALTER TABLE sessions ADD COLUMN started_micros INTEGER;
ALTER TABLE sessions ADD COLUMN ended_micros INTEGER;
-- Column and travel, as JSON.
ALTER TABLE sessions ADD COLUMN machine_shape TEXT;
ALTER TABLE sessions ADD COLUMN reaches INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN reaches_served INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN stops INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN recorded_frames INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN dropped_frames INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN recording_bytes INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN recording_removed TEXT;

CREATE TABLE session_persons (
    session_id INTEGER NOT NULL REFERENCES sessions (id),
    name       TEXT NOT NULL,
    PRIMARY KEY (session_id, name)
) STRICT, WITHOUT ROWID;

-- Which scene was in force from when on.
CREATE TABLE session_scenes (
    session_id    INTEGER NOT NULL REFERENCES sessions (id),
    from_micros   INTEGER NOT NULL,
    scene_id      INTEGER NOT NULL,
    scene_version INTEGER NOT NULL,
    PRIMARY KEY (session_id, from_micros),
    FOREIGN KEY (scene_id, scene_version) REFERENCES scene_versions (scene_id, version)
) STRICT, WITHOUT ROWID;

-- About a second of frames each; the document is deflated JSON, see server/daemon/src/recording/chunk.rs.
CREATE TABLE recording_chunks (
    id           INTEGER PRIMARY KEY,
    session_id   INTEGER NOT NULL REFERENCES sessions (id),
    first_micros INTEGER NOT NULL,
    last_micros  INTEGER NOT NULL,
    frames       INTEGER NOT NULL CHECK (frames > 0),
    document     BLOB NOT NULL,
    UNIQUE (session_id, first_micros)
) STRICT;

-- What was known of sessions of before.
INSERT INTO session_scenes (session_id, from_micros, scene_id, scene_version)
    SELECT id, 0, scene_id, scene_version FROM sessions;
INSERT OR IGNORE INTO session_persons (session_id, name)
    SELECT session_id, json_extract(detail, '$.name') FROM events
    WHERE session_id IS NOT NULL AND kind IN ('person_entered', 'served', 'touch_began')
      AND json_type(detail, '$.name') = 'text';
UPDATE sessions SET
    reaches = (SELECT COUNT(*) FROM events e WHERE e.session_id = sessions.id AND e.kind = 'touch_began'),
    stops = (SELECT COUNT(*) FROM events e WHERE e.session_id = sessions.id AND e.kind = 'mode_changed'
             AND json_extract(e.detail, '$.to') IN ('protective_stop', 'latched_stop'));
