/** Words of the area `desk`. */
export const desk = {} as const;
