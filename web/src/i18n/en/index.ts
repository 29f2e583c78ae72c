export { desk } from "./desk";
export { live } from "./live";
export { machine } from "./machine";
export { hardwareParts, reasons, refusals, troubles } from "./reasons";
export { records } from "./records";
export { scenario } from "./scenario";
export { settings } from "./settings";
export { shell } from "./shell";
