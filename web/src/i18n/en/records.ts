/** Words of the area `records`. */
export const records = {} as const;
