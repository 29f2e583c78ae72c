/** A few keys of a configuration, as the server tells them. */
import type { ConfigInForce } from "../src/api/types";

/** One key is set in the file, one on the command line. */
export const MOCK_CONFIG: ConfigInForce = {
  version: "mock",
  built: { profile: "debug", target: "x86_64-linux", rustc: "1.95.0", commit: null },
  file: "covr.toml",
  keys: [
    { name: "server.bind", value: "127.0.0.1:7913", default: "127.0.0.1:7878", meaning: "Where the server listens.", accepts: "an address and port", takes: { kind: "address" }, from: "command_line" },
    { name: "control.rate_hz", value: 250, default: 250, meaning: "Rate of the control loop, Hz.", accepts: "a number from 50 to 1000", takes: { kind: "number", least: 50, most: 1000 }, from: "default" },
    { name: "people.v_h_mps", value: 2, default: 1.6, meaning: "Greatest speed of a walking person, m/s.", accepts: "a number from 1.6 to 4", takes: { kind: "number", least: 1.6, most: 4 }, from: "file" },
  ],
};
