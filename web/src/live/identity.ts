/**
 * Whom the server takes this page for, and what is open to it. Until the server has said so nothing is taken away: it
 * decides in any case.
 */
import { createSignal, type Accessor } from "solid-js";
import { readMe, signIn, signOut } from "../api/http";
import type { Me } from "../api/types";

/** Who sits at this page. */
export interface Identity {
  /** The server's word; null before it. */
  readonly me: Accessor<Me | null>;
  /** The server asks, and nobody is signed in here. */
  readonly mustSignIn: Accessor<boolean>;
  /** Whether a route (`POST /api/v1/arm`) or a message (`dashboard arm`) is open to this page. */
  readonly may: (key: string) => boolean;
  /** Asks the server again. */
  readonly refresh: () => Promise<void>;
  /** Signs in; why it failed, in words, or null. */
  readonly signIn: (token: string) => Promise<string | null>;
  readonly signOut: () => Promise<void>;
}

/** Asks the server at once; `changed` is told of everybody who signs in or out here. */
export function createIdentity(changed: () => void): Identity {
  const [me, setMe] = createSignal<Me | null>(null);
  const mustSignIn = (): boolean => me()?.asks === true && me()?.role === null;
  const refresh = async (): Promise<void> => {
    try {
      setMe(await readMe());
    } catch {
      // Without an answer nothing is known anew: the connection's own banner says so.
    }
  };
  void refresh();
  return {
    me,
    mustSignIn,
    may: (key) => {
      const known = me();
      return known === null || known.may.includes(key);
    },
    refresh,
    signIn: async (token) => {
      try {
        setMe(await signIn(token));
      } catch (error) {
        return error instanceof Error ? error.message : String(error);
      }
      changed();
      return null;
    },
    signOut: async () => {
      try {
        setMe(await signOut());
      } catch {
        await refresh();
      }
    },
  };
}
