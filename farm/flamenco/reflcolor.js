// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type for Blender's render farm Flamenco: colors the scans that a manifest names.
// Put this file into the folder scripts of the Flamenco Manager. docs/farm.md tells how to submit a job.

const JOB_TYPE = {
    label: "Color laser scans (reflcolor)",
    description: "Colors the scans of a manifest, renders them, and merges the reports.",
    settings: [
        { key: "manifest", type: "string", required: true, subtype: "file_path",
          description: "The manifest of the batch (.toml), on a disk that all workers share." },
        { key: "output", type: "string", required: true, subtype: "dir_path",
          description: "The output folder that the manifest names." },
        { key: "scans", type: "int32", required: true,
          description: "How many scans the manifest names; batch MANIFEST --check says it." },
        { key: "scans_per_task", type: "int32", default: 10, propargs: {min: 1},
          description: "How many scans one task works on. Small scans are best put together." },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    if (!(settings.scans >= 1) || !(settings.scans_per_task >= 1)) {
        throw "scans and scans_per_task: expected whole numbers from 1";
    }
    const looks = stage(settings, "look", []);
    const matches = stage(settings, "match", looks);
    const colors = stage(settings, "color", matches);
    const renders = stage(settings, "render", colors);
    const report = task("report", ["report", settings.output, "--fail"], renders);
    for (const each of [...looks, ...matches, ...colors, ...renders, report]) {
        job.addTask(each);
    }
}

// The tasks of one stage, each of which begins when all of the stage before have ended.
function stage(settings, name, before) {
    const tasks = [];
    for (let first = 1; first <= settings.scans; first += settings.scans_per_task) {
        const last = Math.min(first + settings.scans_per_task - 1, settings.scans);
        const index = `${first}-${last}`;
        tasks.push(task(`${name} ${index}`,
            ["batch", settings.manifest, "--index", index, "--stage", name, "--resume", "--keep-going",
             "--fail-in-report"], before));
    }
    return tasks;
}

function task(name, args, before) {
    const made = author.Task(name, "blender");
    made.addCommand(author.Command("exec", {
        exe: "{blender}",
        args: ["-b", "--command", "reflcolor", ...args],
    }));
    for (const other of before) {
        made.addDependency(other);
    }
    return made;
}
