/** Creates an HTML element in one expression: el("button.small", { title: "…", onclick }, "text", child). */
type Child = Node | string | null | undefined | false;
type Properties = Record<string, unknown>;

export function el<Tag extends keyof HTMLElementTagNameMap>(
  what: Tag | `${Tag}.${string}`,
  properties: Properties = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const [tag, ...classes] = what.split(".");
  const element = document.createElement(tag) as HTMLElementTagNameMap[Tag];
  if (classes.length > 0) element.className = classes.join(" ");
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === false) continue;
    if (name in element && !name.startsWith("aria") && name !== "style") Object.assign(element, { [name]: value });
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) if (child !== null && child !== undefined && child !== false) element.append(child);
  return element;
}

export function select(label: string, options: [value: string, text: string][], value: string,
                       onchange: (value: string) => void): { element: HTMLLabelElement; control: HTMLSelectElement } {
  const control = el("select", { onchange: () => onchange(control.value) });
  for (const [option, text] of options) control.append(el("option", { value: option }, text));
  control.value = value;
  return { element: el("label.control", {}, el("span", {}, label), control), control };
}
