// Texts of inputs and outputs: English, Chinese.
export const io = {
    inputs: ['Inputs', '输入'],
    outputs: ['Outputs', '输出'],
    no_points: ['The machine file names no points.', '机器文件未定义任何点。'],
    doubtful: ['doubtful', '不可信'],
    on: ['on', '通'],
    off: ['off', '断'],
    set: ['Set', '设置'],
    value: ['Value', '值'],
    unit: ['Unit', '单位'],
    outputs_hint: ['Outputs can be set while no program runs; they go back to safe when this page closes or the mode changes.',
        '程序未运行时可设置输出;关闭页面或切换模式后恢复安全值。'],
    outputs_locked: ['A program runs: outputs belong to it.', '程序正在运行:输出由程序控制。'],
    outputs_locked_estop: ['The emergency stop is pressed: outputs cannot be set.', '急停已按下:不能设置输出。'],
} as const satisfies Record<string, readonly [string, string]>;
