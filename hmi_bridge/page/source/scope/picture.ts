// The picture as a file: the lanes' canvases below one another, names, cursors and marker drawn beside and over them.
import { colour_of, dash_of } from './colours';
import { band_height, right_room, scale_width } from './lane_chart';
import { Session } from './session';
import { key_of } from './signals';
import { gutter_width, look, Stack } from './stack';

export function picture(session: Session, stack: Stack): HTMLCanvasElement {
    const canvas = document.createElement('canvas'), ctx = canvas.getContext('2d'), style = look();
    const px = window.devicePixelRatio || 1, charts = stack.charts, head = 24;
    const height = charts.reduce((sum, chart) => sum + chart.plot.height, head);
    const width = gutter_width + (charts[0]?.plot.width ?? 400);
    canvas.width = width * px;
    canvas.height = height * px;
    const { scene } = session;
    if (!ctx || !scene) return canvas;
    ctx.scale(px, px);
    ctx.fillStyle = style.ground;
    ctx.fillRect(0, 0, width, height);
    ctx.fillStyle = style.text;
    ctx.textBaseline = 'middle';
    ctx.font = 'bold 13px system-ui, sans-serif';
    ctx.fillText(`${scene.title}   ${stack.time_of(Math.ceil(scene.view.from))} … ${stack.time_of(Math.floor(scene.view.to))}   ${new Date().toLocaleString('sv')}`, 8, head / 2);
    let top = head;
    for (const chart of charts) {
        ctx.drawImage(chart.plot.ctx.canvas, gutter_width, top, chart.plot.width, chart.plot.height);
        chart.lane.channels.forEach((channel, i) => {
            const y = chart.lane.digital ? top + i * band_height + 4 + band_height / 2 : top + 28 + i * 18;
            ctx.strokeStyle = colour_of(channel.colour, style.dark);
            ctx.lineWidth = 2;
            ctx.setLineDash([...dash_of(channel.colour)]);
            ctx.beginPath();
            ctx.moveTo(8, y);
            ctx.lineTo(34, y);
            ctx.stroke();
            ctx.setLineDash([]);
            ctx.fillStyle = style.text;
            ctx.font = '12px system-ui, sans-serif';
            ctx.fillText(`${session.setup.channels.indexOf(channel) + 1} ${key_of(channel)}${channel.offset === 0 ? '' : ` (${channel.offset > 0 ? '+' : ''}${channel.offset})`}`, 40, y, gutter_width - 44);
        });
        if (!chart.lane.digital) {
            ctx.fillStyle = style.quiet;
            ctx.fillText(chart.lane.unit ? `[${chart.lane.unit}]` : '', 8, top + 12);
        }
        top += chart.plot.height;
    }
    const line = (cycle: number, text: string, colour: string): void => {
        const part = (cycle - scene.view.from) / scene.view.span;
        if (part < 0 || part > 1) return;
        const x = gutter_width + scale_width + part * (width - gutter_width - scale_width - right_room);
        ctx.strokeStyle = ctx.fillStyle = colour;
        ctx.lineWidth = 1;
        ctx.beginPath();
        ctx.moveTo(x, head);
        ctx.lineTo(x, height);
        ctx.stroke();
        ctx.fillText(text, x + 3, head + 8);
    };
    if (scene.marker) line(scene.marker.cycle, `${scene.marker.kind === 'alarm' ? '⚠' : 'T'} ${scene.marker.text}`, style.gap);
    if (session.cursors.shown) {
        line(session.cursors.a, `A ${stack.time_of(session.cursors.a)}`, style.text);
        line(session.cursors.b, `B ${stack.time_of(session.cursors.b)}`, style.text);
    }
    return canvas;
}

/** A canvas that has no ground of its own. */
export function on_ground(from: HTMLCanvasElement): HTMLCanvasElement {
    const canvas = document.createElement('canvas'), ctx = canvas.getContext('2d');
    canvas.width = from.width;
    canvas.height = from.height;
    if (!ctx) return canvas;
    ctx.fillStyle = look().ground;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.drawImage(from, 0, 0);
    return canvas;
}
