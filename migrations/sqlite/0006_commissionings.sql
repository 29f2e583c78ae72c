-- Commissionings are only ever added; the last one counts, for as long as the machine is the one that it was made on.

CREATE TABLE commissionings (
    id           INTEGER PRIMARY KEY AUTOINCREMENT,
    load_kg      REAL NOT NULL CHECK (load_kg >= 0),
    -- Decelerations of x and y (m/s2), the stops that they are from, and the hardware, as JSON.
    braking_mps2 TEXT NOT NULL,
    runs         TEXT NOT NULL,
    hardware     TEXT NOT NULL,
    author       TEXT NOT NULL,
    created      TEXT NOT NULL
) STRICT;

CREATE TRIGGER commissionings_are_not_changed BEFORE UPDATE ON commissionings
    BEGIN SELECT RAISE(ABORT, 'a commissioning is never changed: add another'); END;
CREATE TRIGGER commissionings_are_not_removed BEFORE DELETE ON commissionings
    BEGIN SELECT RAISE(ABORT, 'a commissioning is never removed: add another'); END;
