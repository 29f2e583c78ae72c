/** What a calibration came to, in the page's language. */
import type { CalibrationResult } from "../../api/types";
import { words } from "../../i18n";
import { decimal } from "../../lib/format";

/** One sentence. */
export function resultWords(result: CalibrationResult): string {
  const text = words().machine.calibration;
  const mm = (metres: number): string => decimal(metres * 1e3, 1);
  const degrees = (rad: number, digits: number): string => decimal((rad * 180) / Math.PI, digits);
  if (result.kind === "prop") {
    const facing = result.facing_rad === null ? text.noFacing : text.facing(degrees(result.facing_rad, 1), degrees(result.facing_sd_rad ?? 0, 1));
    return `${text.propIs(decimal(result.offset_m[0], 3), decimal(result.offset_m[1], 3), mm(result.rms_m))} ${facing}`;
  }
  const offset = result.offset_m === null ? "" : ` ${text.rode(result.offset_m.map((value) => decimal(value, 3)).join(" · "))}`;
  return `${text.roomIs(mm(result.rms_m), mm(result.uncertainty_m), degrees(result.tilt_rad, 2), decimal(result.scale, 4))}${offset}`;
}
