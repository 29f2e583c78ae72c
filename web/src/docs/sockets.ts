/** A plain rendering of the AsyncAPI document: channels, what goes which way, each message with schema and examples. */

interface Reference {
  readonly $ref: string;
}

interface Message {
  readonly name: string;
  readonly summary: string;
  readonly payload: unknown;
  readonly examples: readonly { readonly name: string; readonly payload: unknown }[];
}

interface AsyncDocument {
  readonly info: { readonly description: string };
  readonly channels: Readonly<Record<string, { readonly address: string; readonly title: string; readonly description: string }>>;
  readonly operations: Readonly<
    Record<string, { readonly channel: Reference; readonly title: string; readonly description: string; readonly messages: readonly Reference[] }>
  >;
}

/** Fetches the document and appends it; what goes wrong is said in its place. */
export async function renderSockets(url: string, into: HTMLElement): Promise<void> {
  try {
    const response = await fetch(url);
    if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
    into.append(...rendered((await response.json()) as AsyncDocument));
  } catch (error) {
    into.append(element("p", `${url} cannot be shown: ${String(error)}`));
  }
}

/** Everything below the title. */
function rendered(document: AsyncDocument): HTMLElement[] {
  const parts = prose(document.info.description);
  for (const [name, channel] of Object.entries(document.channels)) {
    parts.push(element("h3", `${channel.title}: `, element("code", channel.address)), ...prose(channel.description));
    for (const operation of Object.values(document.operations)) {
      if (operation.channel.$ref !== `#/channels/${name}`) continue;
      parts.push(element("h4", operation.title), ...prose(operation.description));
      for (const reference of operation.messages) {
        parts.push(messageOf(resolved(document, resolved(document, reference) as Reference) as Message));
      }
    }
  }
  return parts;
}

function messageOf(message: Message): HTMLElement {
  const box = element("details", element("summary", element("code", message.name), ` ${message.summary}`));
  box.dataset["testid"] = `message-${message.name}`;
  for (const example of message.examples) box.append(listing("Example", example.payload));
  box.append(listing("Schema", message.payload));
  return box;
}

function listing(title: string, value: unknown): HTMLElement {
  const code = element("pre", JSON.stringify(value, null, 2));
  code.tabIndex = 0;
  code.setAttribute("aria-label", title);
  return element("div", element("h5", title), code);
}

function resolved(document: AsyncDocument, reference: Reference): unknown {
  let at: unknown = document;
  for (const step of reference.$ref.split("/").slice(1)) {
    at = (at as Record<string, unknown>)[step.replaceAll("~1", "/").replaceAll("~0", "~")];
  }
  return at;
}

/** The little Markdown that the document's texts are written in: headings, tables, lists, code and bold words. */
function prose(text: string): HTMLElement[] {
  return text.split(/\n{2,}/).map((block) => {
    const lines = block.split("\n");
    if (block.startsWith("### ")) return element("h5", block.slice(4));
    if (lines.every((line) => line.startsWith("|"))) return table(lines);
    if (lines.every((line) => line.startsWith("- "))) return element("ul", ...lines.map((line) => element("li", ...words(line.slice(2)))));
    return element("p", ...words(block));
  });
}

function table(lines: readonly string[]): HTMLElement {
  const cells = (line: string, kind: "th" | "td"): HTMLElement =>
    element("tr", ...line.split("|").slice(1, -1).map((cell) => element(kind, ...words(cell.trim()))));
  const [head, , ...rows] = lines;
  return element("table", element("thead", cells(head ?? "", "th")), element("tbody", ...rows.map((row) => cells(row, "td"))));
}

function words(text: string): (string | HTMLElement)[] {
  return text.split(/(`[^`]+`|\*\*[^*]+\*\*)/).map((part) => {
    if (part.startsWith("`")) return element("code", part.slice(1, -1));
    if (part.startsWith("**")) return element("strong", part.slice(2, -2));
    return part;
  });
}

function element<K extends keyof HTMLElementTagNameMap>(name: K, ...children: (string | Node)[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  made.append(...children);
  return made;
}
