//! Support shared by the test suites.
