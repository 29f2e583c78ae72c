//! The covr daemon.
