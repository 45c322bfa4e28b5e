// The spectrum of every sample between the cursors, or of what is shown: one lane's curves, a frequency cursor, the largest line of each.
import uPlot from 'uplot';
import { Key, say } from '../texts';
import { element, mark, Rows, write } from '../view';
import { colour_of, dash_of } from './colours';
import { figure_text, measured } from './cursors';
import { decibel, Spectrum, spectrum, windows } from './fft';
import { Lane, lanes_of } from './lanes';
import { Session } from './session';
import { Channel, key_of } from './signals';
import { look, sample_of } from './stack';

/** Samples of one spectrum: two minutes at 1 kHz. */
const most_samples = 131_072;
const again_after = 500;

interface Line {
    root: HTMLElement;
    cells: HTMLElement[];
}

/** The greatest amplitude but for the mean. */
export function largest(of: Spectrum): { hz: number; amplitude: number } {
    let best = 1;
    for (let k = 2; k < of.amplitude.length; k++) if ((of.amplitude[k] as number) > (of.amplitude[best] as number)) best = k;
    return { hz: best * of.line_hz, amplitude: of.amplitude[best] ?? NaN };
}

export class SpectrumView {
    readonly root: HTMLElement;
    private readonly host_ = element('div', { class: 'scope-chart', tabindex: '0', role: 'application', 'aria-label': say('scope_view_spectrum') });
    private readonly hint_ = element('p', { class: 'hint' });
    private readonly lane_ = element('select', { 'data-field': 'lane', 'aria-label': say('scope_curve'), onchange: () => this.take() });
    private readonly window_ = element('select', { 'data-field': 'window', onchange: () => this.take() }, ...windows.map((w) => element('option', { value: w }, say(`scope_window_${w}` as Key))));
    private readonly decibel_ = element('input', { type: 'checkbox', 'data-field': 'decibel', onchange: () => this.take() });
    private readonly rows_: Rows<Channel, Line>;
    private readonly at_ = element('th', { scope: 'col', class: 'number' });
    private plot_: uPlot | undefined;
    private found_: { channel: Channel; spectrum: Spectrum | undefined }[] = [];
    private lanes_: Lane[] = [];
    private offered_ = '';
    private drawn_ = '';
    private drawn_at_ = 0;
    /** Hz. */
    private cursor_ = NaN;
    /** Hz that are shown; undefined: all. */
    private zoom_: { min: number; max: number } | undefined;

    constructor(private readonly session_: Session, private readonly changed_: () => void) {
        const body = element('tbody');
        this.rows_ = new Rows<Channel, Line>(body, (channel) => `${key_of(channel)} ${channel.colour}`, (channel) => {
            const cells = ['at', 'largest', 'largest_hz'].map((name) => element('td', { class: 'number', 'data-value': name }));
            return { root: element('tr', { 'data-row': key_of(channel) }, element('th', { scope: 'row' }, sample_of(channel), ' ', key_of(channel)), element('td', {}, session_.signal(channel.name)?.unit ?? ''), ...cells), cells };
        }, () => undefined);
        const head = element('tr', {}, ...(['scope_curve', 'unit'] as const).map((k) => element('th', { scope: 'col' }, say(k))), this.at_, ...(['scope_largest', 'scope_frequency'] as const).map((k) => element('th', { scope: 'col', class: 'number' }, say(k))));
        this.root = element('div', { class: 'scope-other spectrum' },
            element('div', { class: 'scope-options' }, this.lane_, element('label', {}, element('span', {}, say('scope_window')), this.window_), element('label', {}, element('span', {}, say('scope_decibel')), this.decibel_), this.hint_),
            this.host_, element('div', { class: 'scope-values' }, element('div', { class: 'scope-scroll' }, element('table', {}, element('thead', {}, head), body))));
        this.host_.addEventListener('pointerdown', (event) => {
            const plot = this.plot_;
            if (!plot) return;
            this.move_to(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, 'x'));
        });
        this.host_.addEventListener('wheel', (event) => {
            const plot = this.plot_, one = this.found_.find((f) => f.spectrum)?.spectrum;
            if (!plot || !one) return;
            event.preventDefault();
            const last = (one.amplitude.length - 1) * one.line_hz, now = this.zoom_ ?? { min: 0, max: last }, factor = 1.25 ** (event.deltaY / 100);
            const about = plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, 'x');
            const min = Math.max(0, about - (about - now.min) * factor), max = Math.min(last, about + (now.max - about) * factor);
            this.zoom_ = max - min > 8 * one.line_hz ? { min, max } : now;
            this.again();
        }, { passive: false });
        this.host_.addEventListener('dblclick', () => {
            this.zoom_ = undefined;
            this.again();
        });
        this.host_.addEventListener('keydown', (event) => {
            const step = event.key === 'ArrowRight' ? 1 : event.key === 'ArrowLeft' ? -1 : 0, line = this.found_.find((f) => f.spectrum)?.spectrum?.line_hz;
            if (step === 0 || line === undefined) return;
            event.preventDefault();
            event.stopPropagation();
            this.move_to((Number.isNaN(this.cursor_) ? 0 : this.cursor_) + step * line * (event.shiftKey ? 10 : 1));
        });
    }
    private again(): void {
        this.drawn_ = '';
        this.drawn_at_ = -1e9;
        this.draw();
    }
    private take(): void {
        this.session_.setup.spectrum = { lane: this.lane_.value, window: windows.find((w) => w === this.window_.value) ?? 'hann', decibel: this.decibel_.checked };
        this.changed_();
        this.draw();
    }
    /** On to the nearest line. */
    private move_to(hz: number): void {
        const one = this.found_.find((f) => f.spectrum)?.spectrum;
        if (!one) return;
        const line = Math.min(one.amplitude.length - 1, Math.max(0, Math.round(hz / one.line_hz)));
        this.cursor_ = line * one.line_hz;
        this.plot_?.redraw(false);
        this.tell();
    }

    draw(): void {
        const { scene, setup, cursors } = this.session_, now = performance.now();
        if (!scene) return;
        this.lanes_ = lanes_of(setup.channels, (name) => scene.signals.get(name)).filter((lane) => !lane.digital);
        const offered = JSON.stringify([this.lanes_.map((l) => [l.key, l.channels.map(key_of)]), setup.spectrum]);
        if (offered !== this.offered_) {
            this.offered_ = offered;
            this.lane_.replaceChildren(...this.lanes_.map((lane) => element('option', { value: lane.key }, `${lane.unit ? `[${lane.unit}] ` : ''}${lane.channels.map((c) => c.name).join(', ').slice(0, 60)}`)));
            this.lane_.value = (this.lanes_.find((l) => l.key === setup.spectrum.lane) ?? this.lanes_[0])?.key ?? '';
            this.window_.value = setup.spectrum.window;
            this.decibel_.checked = setup.spectrum.decibel;
        }
        const lane = this.lanes_.find((l) => l.key === this.lane_.value), width = this.host_.clientWidth, height = this.host_.clientHeight;
        const range = measured(cursors, scene.view.from, scene.view.to), to = Math.min(range.to, scene.store.newest), from = Math.max(range.from, to - most_samples);
        const drawn = JSON.stringify([lane?.key, lane?.channels, from, to, width, height, setup.spectrum, look().dark, scene.title, lane?.channels.map((c) => scene.store.has(c.name, from, to))]);
        if (!lane || width < 50 || height < 50 || drawn === this.drawn_ || now - this.drawn_at_ < again_after) return;
        this.drawn_ = drawn;
        this.drawn_at_ = now;
        this.found_ = lane.channels.filter((c) => !c.hidden).map((channel) => ({ channel, spectrum: spectrum(scene.store.copy(channel.name, from, to), 1e9 / scene.cycle_ns, setup.spectrum.window) }));
        const first = this.found_.find((f) => f.spectrum)?.spectrum, without = this.found_.find((f) => !f.spectrum);
        const texts = [
            first ? say('scope_spectrum_hint', { count: String(to - from), line: String(Number(first.line_hz.toPrecision(4))) }) : '', without ? say('scope_spectrum_gap', { name: key_of(without.channel) }) : '',
            range.to - range.from > most_samples ? say('scope_spectrum_long', { count: String(most_samples) }) : '',
        ];
        write(this.hint_, texts.filter((t) => t !== '').join(' '));
        if (first && Number.isNaN(this.cursor_)) this.cursor_ = largest(first).hz;
        if (first) this.cursor_ = Math.min(first.amplitude.length - 1, Math.round(this.cursor_ / first.line_hz)) * first.line_hz;
        this.make(width, height, lane.unit);
        this.tell();
    }
    private shown(amplitude: number): number {
        return this.session_.setup.spectrum.decibel ? Math.max(-400, decibel(amplitude)) : amplitude;
    }
    private make(width: number, height: number, unit: string): void {
        this.plot_?.destroy();
        const style = look(), in_db = this.session_.setup.spectrum.decibel, one = this.found_.find((f) => f.spectrum)?.spectrum;
        const axis = { stroke: style.quiet, font: style.font, labelFont: style.font, labelSize: 18, grid: { stroke: style.grid, width: 1 }, ticks: { stroke: style.grid, width: 1 },
            values: (_plot: uPlot, splits: number[]) => splits.map((s) => String(Number(s.toPrecision(6))).replace('-', '−')) };
        const lines = one?.amplitude.length ?? 0;
        const data: uPlot.AlignedData = [Float64Array.from({ length: lines }, (_, k) => k * (one?.line_hz ?? 0)), ...this.found_.map((f) => Float64Array.from({ length: lines }, (_, k) => this.shown(k === 0 ? NaN : f.spectrum?.amplitude[k] ?? NaN)))];
        let high = -Infinity;
        const zoom = this.zoom_, line_hz = one?.line_hz ?? 1;
        const first = Math.max(1, Math.floor((zoom?.min ?? 0) / line_hz)), last = Math.min(lines - 1, Math.ceil((zoom?.max ?? Infinity) / line_hz));
        for (const { spectrum: of } of this.found_) for (let k = first; of && k <= last; k++) high = Math.max(high, of.amplitude[k] as number);
        const top = Number.isFinite(high) && high > 0 ? high : 1;
        const range: [number, number] = in_db ? [decibel(top) - 100, decibel(top) + 5] : [0, top * 1.06];
        this.plot_ = new uPlot({
            width, height, legend: { show: false }, cursor: { show: false }, padding: [10, 16, 0, 0],
            scales: { x: { time: false, range: (_p, low, up) => (zoom ? [zoom.min, zoom.max] : [low, up]) }, y: { auto: false, range: () => range } },
            axes: [{ ...axis, label: `${say('scope_frequency')} [Hz]` }, { ...axis, label: `${say('scope_amplitude')} [${in_db ? `dB${unit ? ` re 1 ${unit}` : ''}` : unit || '1'}]`, size: 66 }],
            series: [{}, ...this.found_.map((f) => ({ stroke: colour_of(f.channel.colour, style.dark), dash: [...dash_of(f.channel.colour)], width: 1.5, points: { show: false } }))],
            hooks: { draw: [(plot) => this.draw_cursor(plot, style.text)] },
        }, data, this.host_);
    }
    private draw_cursor(plot: uPlot, ink: string): void {
        if (Number.isNaN(this.cursor_)) return;
        const ctx = plot.ctx, x = plot.valToPos(this.cursor_, 'x', true), { top, height } = plot.bbox;
        ctx.save();
        ctx.strokeStyle = ink;
        ctx.lineWidth = uPlot.pxRatio;
        ctx.setLineDash([4 * uPlot.pxRatio, 3 * uPlot.pxRatio]);
        ctx.beginPath();
        ctx.moveTo(x, top);
        ctx.lineTo(x, top + height);
        ctx.stroke();
        ctx.restore();
    }
    private tell(): void {
        this.rows_.update(this.found_.map((f) => f.channel));
        const unit = this.session_.setup.spectrum.decibel ? ' dB' : '';
        write(this.at_, `${Number(this.cursor_.toPrecision(7))} Hz`);
        mark(this.host_, 'aria-description', this.at_.textContent ?? '');
        for (const { channel, spectrum: of } of this.found_) {
            const cells = this.rows_.row(`${key_of(channel)} ${channel.colour}`)?.cells ?? [], peak = of ? largest(of) : undefined;
            const at = of ? of.amplitude[Math.round(this.cursor_ / of.line_hz)] ?? NaN : NaN;
            const texts = of && peak ? [figure_text(this.shown(at)) + unit, figure_text(this.shown(peak.amplitude)) + unit, `${figure_text(peak.hz)} Hz`] : ['–', '–', '–'];
            cells.forEach((cell, i) => write(cell, texts[i] ?? ''));
        }
    }
    canvas(): HTMLCanvasElement | undefined {
        return this.plot_?.ctx.canvas;
    }
}
