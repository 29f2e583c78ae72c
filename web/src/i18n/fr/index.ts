export { desk } from "./desk";
export { live } from "./live";
export { reasons } from "./reasons";
export { records } from "./records";
export { settings } from "./settings";
export { shell } from "./shell";
