// Runs one Python script on MicroPython's WebAssembly port, with the host's files copied into its
// in-memory file system and the files it wrote copied back.
// usage: node runner.mjs JOB.json   (fields: package folder script argv modules files_out heap)

import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const job = JSON.parse(fs.readFileSync(process.argv[2], "utf8"));
const { loadMicroPython } = await import(pathToFileURL(path.join(job.package, "micropython.mjs")));

const stdin = fs.readFileSync(0);
let read = 0;
const options = {
    linebuffer: false,
    stdin: () => (read < stdin.length ? stdin[read++] : null),
    stdout: writerTo(1),
    stderr: writerTo(2),
};
if (job.heap !== null) {
    options.heapsize = job.heap;
}
const micropython = await loadMicroPython(options);
loadFolder(job.folder, "/work", () => true);
job.modules.forEach((folder, i) => {
    loadFolder(folder, `/modules${i}`, (name) => name.endsWith(".py") || name.endsWith(".mpy"));
});
micropython.FS.chdir("/work");
micropython.runPython(`
import sys
sys.argv[:] = ${JSON.stringify([job.script, ...job.argv])}
sys.path[:] = ['', '.frozen'] + ${JSON.stringify(job.modules.map((_, i) => `/modules${i}`))}
del sys
`);
// An exception that leaves the interpreter while the heap is locked would never end.
process.exitCode = run(`
import micropython as _micropython
with open(${JSON.stringify(job.script)}) as _script:
    _script = compile(_script.read(), ${JSON.stringify(job.script)}, "exec")
try:
    exec(_script)
finally:
    _micropython.heap_lock()
    while _micropython.heap_unlock():
        pass
`);
options.stdout.flush();
options.stderr.flush();
saveFiles();

function run(source) {
    try {
        micropython.runPython(source);
        return 0;
    } catch (error) {
        if (error.name !== "PythonError") {
            throw error;
        }
        if (error.type === "SystemExit") {
            return exitCode(error.message);
        }
        options.stdout.flush();
        fs.writeSync(2, error.message);
        return 1;
    }
}

function exitCode(message) {
    const said = message.trimEnd().split("SystemExit:").pop().trim();
    if (said === "" || said === "None") {
        return 0;
    }
    if (/^-?\d+$/.test(said)) {
        return Number(said) & 255;
    }
    fs.writeSync(2, said + "\n");
    return 1;
}

// One byte at a time comes in; a system call for each would cost more than the interpreter.
function writerTo(descriptor) {
    const waiting = [];
    const write = (bytes) => {
        waiting.push(...bytes);
        if (waiting.length >= 8192) {
            write.flush();
        }
    };
    write.flush = () => {
        const block = Buffer.from(waiting.splice(0));
        for (let done = 0; done < block.length; ) {
            done += fs.writeSync(descriptor, block, done);
        }
    };
    return write;
}

function loadFolder(from, to, wanted) {
    micropython.FS.mkdirTree(to);
    for (const entry of fs.readdirSync(from, { withFileTypes: true })) {
        const source = path.join(from, entry.name);
        const target = `${to}/${entry.name}`;
        if (fs.statSync(source).isDirectory()) {
            if (!entry.name.startsWith(".") && entry.name !== "__pycache__") {
                loadFolder(source, target, wanted);
            }
        } else if (wanted(entry.name)) {
            micropython.FS.writeFile(target, fs.readFileSync(source));
        }
    }
}

function saveFiles() {
    for (const name of job.files_out) {
        if (micropython.FS.analyzePath(`/work/${name}`).exists) {
            const target = path.join(job.folder, name);
            fs.mkdirSync(path.dirname(target), { recursive: true });
            fs.writeFileSync(target, micropython.FS.readFile(`/work/${name}`));
        }
    }
}
