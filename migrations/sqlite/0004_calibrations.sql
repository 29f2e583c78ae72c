-- Calibrations are only ever added: a new one of the same subject is its next version, and which is in force is a list of choices.

CREATE TABLE calibrations (
    id       INTEGER PRIMARY KEY AUTOINCREMENT,
    kind     TEXT NOT NULL CHECK (kind IN ('room_from_tracking', 'prop')),
    -- Of what: a VR client's name, or a scene's prop.
    subject  TEXT NOT NULL,
    version  INTEGER NOT NULL CHECK (version >= 1),
    -- Result, points with residuals, and the hardware that it was made on, as JSON.
    result   TEXT NOT NULL,
    points   TEXT NOT NULL,
    hardware TEXT NOT NULL,
    author   TEXT NOT NULL,
    created  TEXT NOT NULL,
    UNIQUE (kind, subject, version)
) STRICT;

-- The last choice of a kind and subject is in force; null: none is.
CREATE TABLE calibration_choices (
    id             INTEGER PRIMARY KEY AUTOINCREMENT,
    kind           TEXT NOT NULL,
    subject        TEXT NOT NULL,
    calibration_id INTEGER REFERENCES calibrations (id),
    author         TEXT NOT NULL,
    at             TEXT NOT NULL
) STRICT;

CREATE INDEX calibration_choices_by_subject ON calibration_choices (kind, subject, id);

CREATE TRIGGER calibrations_are_not_changed BEFORE UPDATE ON calibrations
    BEGIN SELECT RAISE(ABORT, 'a calibration is never changed: add another'); END;
CREATE TRIGGER calibrations_are_not_removed BEFORE DELETE ON calibrations
    BEGIN SELECT RAISE(ABORT, 'a calibration is never removed: put another in force'); END;
CREATE TRIGGER calibration_choices_are_not_changed BEFORE UPDATE ON calibration_choices
    BEGIN SELECT RAISE(ABORT, 'a choice is never changed: add another'); END;
CREATE TRIGGER calibration_choices_are_not_removed BEFORE DELETE ON calibration_choices
    BEGIN SELECT RAISE(ABORT, 'a choice is never removed: add another'); END;
