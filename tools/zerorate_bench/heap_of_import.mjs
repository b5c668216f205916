// Prints the heap that `import NAME` takes for good on MicroPython's WebAssembly port.
// That port collects garbage between two scripts only: gc.collect() within one does nothing.
// usage: node heap_of_import.mjs PACKAGE FOLDER NAME

import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const [packageFolder, folder, name] = process.argv.slice(2);
const { loadMicroPython } = await import(
    pathToFileURL(path.join(packageFolder, "micropython.mjs"))
);
const micropython = await loadMicroPython({});
load(path.join(folder, name), `/modules/${name}`);
const scripts = [
    "import gc, sys\nsys.path[:] = ['/modules']\ngc.collect()",
    "gc.collect()",
    "before = gc.mem_alloc()",
    `import ${name}`,
    "gc.collect()",
    "gc.collect()",
    "print(gc.mem_alloc() - before)",
];
for (const script of scripts) {
    micropython.runPython(script);
}

function load(from, to) {
    micropython.FS.mkdirTree(to);
    for (const entry of fs.readdirSync(from, { withFileTypes: true })) {
        const source = path.join(from, entry.name);
        if (entry.isDirectory()) {
            load(source, `${to}/${entry.name}`);
        } else if (entry.name.endsWith(".py")) {
            micropython.FS.writeFile(`${to}/${entry.name}`, fs.readFileSync(source));
        }
    }
}
