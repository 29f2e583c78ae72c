/** Asks for a token where the server wants to know who looks on. The stop works without. */
import { createSignal, Show, type JSX } from "solid-js";
import { words } from "../i18n";
import type { Identity } from "../live/identity";

/** The bar with the form. */
export function SignIn(props: { readonly identity: Identity }): JSX.Element {
  const [token, setToken] = createSignal("");
  const [trouble, setTrouble] = createSignal<string | null>(null);
  return (
    <Show when={props.identity.mustSignIn()}>
      <form
        class="bar sign-in"
        data-testid="sign-in"
        onSubmit={(event) => {
          event.preventDefault();
          setTrouble(null);
          void props.identity.signIn(token()).then((why) => {
            setTrouble(why);
            if (why === null) setToken("");
          });
        }}
      >
        <label for="token">{words().shell.access.signInWith}</label>
        <input
          id="token"
          data-testid="token"
          type="password"
          autocomplete="current-password"
          placeholder="covr_…"
          required
          value={token()}
          onInput={(event) => setToken(event.currentTarget.value)}
        />
        <button type="submit" data-testid="sign-in-confirm">{words().shell.access.signIn}</button>
        <span>{words().shell.access.stopWorks}</span>
        <Show when={trouble()}>
          {(why) => <span class="bad" role="alert" data-testid="sign-in-trouble">{why()}</span>}
        </Show>
      </form>
    </Show>
  );
}
