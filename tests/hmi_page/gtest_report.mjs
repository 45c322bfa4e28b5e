// What `./dev test` counts: one line of <testsuites> and one of each <testcase>, as GoogleTest writes them.
const escaped = (text) => String(text).replace(/[&<>"\n]/g, (c) => `&#${c.charCodeAt(0)};`);

export default async function* report(source) {
    const cases = [];
    for await (const { type, data } of source)
        if ((type === 'test:pass' || type === 'test:fail') && data.details?.type !== 'suite' && !data.name.endsWith('.mjs'))
            cases.push({ name: data.name, failed: type === 'test:fail', skipped: data.skip });
    yield `<?xml version="1.0" encoding="UTF-8"?>\n<testsuites tests="${cases.length}" failures="${cases.filter((c) => c.failed).length}" errors="0" disabled="0">\n`;
    for (const { name, failed, skipped } of cases)
        yield skipped ? `<testcase name="${escaped(name)}" result="skipped">\n<skipped message="${escaped(skipped)}"/>\n</testcase>\n`
            : `<testcase name="${escaped(name)}" result="completed">${failed ? '<failure/>' : ''}</testcase>\n`;
    yield '</testsuites>\n';
}
