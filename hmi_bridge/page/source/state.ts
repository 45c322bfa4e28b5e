// What the machine says of itself: the JSON of its local socket (hmi_bridge/socket/json_state.cpp), as it comes.

/** JSON has no NaN and no infinity; such a value comes as the text "NaN", "Infinity" or "-Infinity". Read it by value(). */
export type Real = number | string;
export const value = (real: Real | null | undefined): number => (real === undefined || real === null ? NaN : Number(real));

export interface AxisState {
    name: string;
    unit: string;
    state: string;
    owner: string;
    disabled: boolean;
    simulated: boolean;
    online: boolean;
    powered: boolean;
    homed: boolean;
    in_position: boolean;
    has_job: boolean;
    command: string;
    block: string;
    held_by_stop: boolean;
    queued: number;
    resetting: boolean;
    warning: boolean;
    error: number;
    /** What stopped it, where a table has it; in English. */
    error_name?: string;
    error_cause?: string;
    error_remedy?: string;
    drive_error: number;
    actual_position: Real;
    actual_velocity: Real;
    actual_torque: Real;
    set_position: Real;
    set_velocity: Real;
    set_acceleration: Real;
    set_jerk: Real;
    target_position: Real;
    following_error: Real;
    following_window: Real;
    velocity_limiter: string;
    override: Real;
    turns: number;
    drive_state: string;
    drive_mode: string;
    status_word: number;
    negative_limit_switch: boolean;
    positive_limit_switch: boolean;
    home_switch: boolean;
    // What an older runtime does not say.
    enable?: boolean;
    enable_positive?: boolean;
    enable_negative?: boolean;
    /** Least and greatest of all cycles since the start, or since somebody began anew. */
    following_error_min?: Real;
    following_error_max?: Real;
    operators_override?: Real;
    /** Limits and speeds as they hold now; those of the layout are the machine file's. */
    position_min?: Real | null;
    position_max?: Real | null;
    brake?: string;
    master?: string;
}

export interface ForcedPoint {
    point: string;
    direction: 'input' | 'output';
    value: Real;
    by: string;
}

export interface Alarm {
    id: number;
    name: string;
    source: string;
    since_ns: number;
    count: number;
    standing: boolean;
    acknowledged: boolean;
    reaction: string;
    english: string;
    chinese: string;
    cause: string;
    remedy: string;
    reset: string;
    /** The section of the manual that treats it. */
    manual?: string;
    /** The name of what was recorded around it. */
    recording?: string;
}

export interface CommandEvent {
    number: number;
    time_ns: number;
    event: string;
    /** Empty: it is a group's. */
    axis: string;
    group?: string;
    times: number;
    english: string;
    remedy: string;
}

/** What a member uses of its limits is a part: 1 = at the limit. */
export interface GroupMember {
    axis: string;
    ident: number;
    unit: string;
    set_position: Real;
    actual_position: Real;
    set_velocity: Real;
    velocity_use: Real;
    acceleration_use: Real;
    jerk_use: Real;
}

/** X Y Z in the group's unit, RX RY RZ in degrees. */
export type ToolPose = [Real, Real, Real, Real, Real, Real];

/** The tool seen from a frame that is not the machine's. */
export interface GroupFrame {
    /** "wcs", "pcs", "pcs_2" ... */
    frame: string;
    /** With whose way it moves; empty: it stands. */
    axis: string;
    tool_set: ToolPose;
    tool_actual: ToolPose;
}

/** What a group has refused of its program's commands, last: why, and where on the path and in the machine. In English. */
export interface GroupRefusal {
    number: number;
    error: string;
    text: string;
    remedy: string;
    command: string;
    block: string;
    where: string;
}

export interface GroupState {
    name: string;
    unit: string;
    state: string;
    interrupted: boolean;
    /** It was a person. */
    held: boolean;
    resetting: boolean;
    powered: boolean;
    online: boolean;
    in_position: boolean;
    error: number;
    /** In English. */
    error_name?: string;
    error_text?: string;
    error_cause?: string;
    error_remedy?: string;
    members: GroupMember[];
    tool_known: boolean;
    tool_set: ToolPose;
    tool_actual: ToolPose;
    /** Absent from an older runtime, as all of `track` and `path_deviation`. */
    frames?: GroupFrame[];
    /** Until another motion begins. */
    refusal?: GroupRefusal;
    tool_speed: Real;
    tool_actual_speed: Real;
    /** Of a path of axes that turn: "deg". Absent from an older runtime. */
    path_unit?: string;
    path_velocity: Real;
    path_acceleration: Real;
    path_deviation?: Real;
    /** "belt", "table"; "none". */
    track?: string;
    track_axis?: string;
    track_in_sync?: boolean;
    track_lag?: Real;
    tool_limit?: Real;
    limiter: string;
    limiting_axis: string;
    command: string;
    block: string;
    command_id: number;
    progress: Real;
    distance_to_go: Real;
    remaining_s: Real;
    queued: number;
    override: Real;
    operators_override: Real;
}

export interface MachineState {
    machine: string;
    cycle: number;
    time_ns: number;
    phase: string;
    mode: string;
    emergency_stop: boolean;
    /** It counts as pressed because its input cannot be read. */
    emergency_stop_unread?: boolean;
    simulated: boolean;
    statistics: Record<string, number>;
    bus: Record<string, number | string>;
    slaves: { name: string; state: string; al_status_code: number; fresh: boolean; age: number }[];
    axes: AxisState[];
    /** Absent from an older runtime. */
    groups?: GroupState[];
    programs: { name: string; state: string }[];
    tasks: { name: string; releases: number; overruns: number; run_ns: number; run_max_ns: number }[];
    input_units: Record<string, string>;
    output_units: Record<string, string>;
    inputs: Record<string, Real>;
    outputs: Record<string, Real>;
    doubtful_inputs: string[];
    variables: { program: string; name: string; unit: string; value: Real }[];
    parameters: { program: string; name: string; unit: string; value: Real }[];
    alarms: Alarm[];
    events: CommandEvent[];
    forced?: ForcedPoint[];
    /** The newest measurement; null: there was none. */
    measure?: { run: number; axis: string; kind: string; running: boolean; end: string; elapsed_s: number; duration_s: number } | null;
}

export interface AxisLayout {
    name: string;
    unit: string;
    disabled: boolean;
    simulated: boolean;
    jog_slow: Real;
    jog_fast: Real;
    /** Software limits, in force once homed; null: none; absent from an older runtime. So are the others. */
    position_min?: Real | null;
    position_max?: Real | null;
    velocity_limit?: Real;
    acceleration_limit?: Real;
    jerk_limit?: Real | null;
    following_window?: Real | null;
    /** u; 0: a line. */
    modulo?: Real;
    drive: string;
    profile: string;
    drive_axis: number;
}

export interface GroupLayout {
    name: string;
    unit: string;
    members: string[];
    arm: boolean;
    /** Which of X Y Z RX RY RZ the arm commands. */
    commands: boolean[];
    /** u/s of the tool's point in set-up mode, and of a jog; 0: no arm. Absent from an older runtime. */
    setup_velocity?: number;
}

export interface MachineLayout {
    machine: string;
    cycle_ns: number;
    axes: AxisLayout[];
    groups?: GroupLayout[];
    slaves: string[];
    inputs: string[];
    outputs: string[];
    /** Points that nobody may force, and why. */
    kept_inputs?: Record<string, string>;
    kept_outputs?: Record<string, string>;
    programs: string[];
    tasks: string[];
    variables: { program: string; name: string; unit: string; doc: string; type: string }[];
    parameters: { program: string; name: string; unit: string; doc: string; minimum: Real; maximum: Real; whole: boolean; value: Real }[];
}
