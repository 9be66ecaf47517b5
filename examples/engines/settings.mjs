// The settings of a page: those of settings.json here and in the page's folder. Each has a default or how many numbers it
// takes (then null stands for "not given"; 0: any number of them, as a list), or its choices, of which the first is the default, or
// is the path of a file. A setting of the map ("of_map") is not given beside `lines`, which set the map themselves. One that has
// "with" is given only beside a value of another setting that stands there.
import { existsSync, readFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));

function rows_of(page) {
  const read = (folder) => JSON.parse(readFileSync(path.join(here, folder, "settings.json"), "utf8"));
  return { ...read("."), ...read(path.dirname(page)) };
}
const default_of = (row) => row.default ?? row.choices?.[0] ?? null;
const count_of = (row) => row.numbers ?? [row.default].flat().length;
function takes(row) {
  if (row.choices) return row.choices.join(" | ");
  if (row.file) return "the path of a file that is there";
  const many = count_of(row);
  const kind = `${row.whole ? "whole " : ""}number`;
  return (many === 1 ? `a ${kind}` : `${many ? many + " " : ""}${kind}s with commas`) + (row.above === undefined ? "" : ` above ${row.above}`);
}
// What the text says, or undefined if it is none of what the setting takes.
function value_of(row, text) {
  if (row.choices) return row.choices.includes(text) ? text : undefined;
  if (row.file) return existsSync(text) ? text : undefined;
  const many = count_of(row), numbers = text.split(",").map((part) => (part.trim() ? Number(part) : NaN));
  const good = (x) => Number.isFinite(x) && (!row.whole || Number.isInteger(x)) && !(x <= row.above);
  if ((many && numbers.length !== many) || !numbers.every(good)) return undefined;
  return many === 1 ? numbers[0] : numbers;
}

// All settings of the page with their values, from the "name=value" of a command line. Throws an Error that lists the
// settings if one is unknown, given twice, or is not what the setting takes.
export function settings_of(page, given) {
  const rows = rows_of(page), values = {};
  const list = () => Object.entries(rows).map(([name, row]) => {
    const otherwise = default_of(row) === null ? "" : ` (${default_of(row)})`;
    return `  ${name}=${takes(row)}${row.choices ? "" : otherwise}${row.means ? ", " + row.means : ""}`;
  }).join("\n");
  const fail = (what) => { throw Error(`${what} The settings of ${page} are\n${list()}`); };
  for (const one of given) {
    const [, name, text] = /^([^=]*)=(.*)$/s.exec(one) ?? fail(`"${one}" is no name=value.`);
    if (!Object.hasOwn(rows, name)) fail(`"${one}": there is no setting "${name}".`);
    if (Object.hasOwn(values, name)) fail(`"${one}": "${name}" is given twice.`);
    values[name] = value_of(rows[name], text) ?? fail(`"${one}": "${name}" takes ${takes(rows[name])}.`);
  }
  if (values.lines)
    for (const name of Object.keys(values))
      if (rows[name].of_map) fail(`"${name}" and "lines" are given, and the lines set the map. Leave "${name}" out.`);
  const names = Object.keys(values);
  for (const [name, row] of Object.entries(rows)) values[name] ??= default_of(row);
  for (const name of names)
    for (const [other, wanted] of Object.entries(rows[name].with ?? {}))
      if (!wanted.includes(values[other])) fail(`"${name}" has no effect with ${other}=${values[other]}; it needs ${other}=${wanted.join(" or ")}.`);
  return values;
}
