/** Words of the area `live`. */
export const live = {} as const;
