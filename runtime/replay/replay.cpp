#include "runtime/replay/replay.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <stdlib.h>

#include "runtime/machine/replayed_inbox.hpp"
#include "runtime/replay/recording_head.hpp"
#include "runtime/replay/replay_transport.hpp"
#include "runtime/replay/stand_ins.hpp"
#include "runtime/replay/step_reader.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

/// More than one cycle can record.
constexpr std::size_t one_step = std::size_t{4} << 20;

std::optional<std::int64_t> number_of(const RecordingInfo& info, std::string_view name) {
    const auto* text = find_fact(info, name);
    std::int64_t value = 0;
    if (text == nullptr || std::from_chars(text->data(), text->data() + text->size(), value).ec != std::errc{}) return std::nullopt;
    return value;
}

const RecordView* first_of(std::span<const RecordView> records, RecordChannel channel) {
    const auto found = std::ranges::find(records, channel, &RecordView::channel);
    return found == records.end() ? nullptr : &*found;
}

/// What has to be so before anything is built.
std::optional<Error> unfit(const MachineConfig& config, const RecordSource& recording) {
    const auto& info = recording.info();
    const auto* machine = find_fact(info, head_fact::machine);
    if (machine == nullptr)
        return Error{"replay.not_of_a_machine", "recording", "this recording is not of a machine",
                     "give a file of `taktwerk run --record`"};
    if (info.channels != inbox_channels())
        return Error{"replay.channels", "recording", "what is recorded in it is arranged otherwise than this taktwerk does it",
                     "replay it with the taktwerk that recorded it; `taktwerk replay --show` says which"};
    if (recording.lost() > 0)
        return Error{
            "replay.lost", "recording",
            fmt::format("{} records did not reach the file while it was recorded: from there on nothing is certain", recording.lost()),
            "record onto a disk that keeps up"};
    if (*machine != config.name)
        return Error{"replay.other_machine", "recording", fmt::format("it is of machine '{}', and this is '{}'", *machine, config.name),
                     "give the machine file that was recorded"};
    if (const auto cycle = number_of(info, head_fact::cycle); cycle != config.cycle.count())
        return Error{
            "replay.other_machine", "recording",
            fmt::format("its cycle is {} us, and that of this machine file {} us", cycle.value_or(0) / 1000, config.cycle.count() / 1000),
            "give the machine file that was recorded"};
    return std::nullopt;
}

/// Of what the machine keeps.
struct Folder {
    fs::path path;
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    static std::unique_ptr<Folder> make() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-replay-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) return nullptr;
        auto folder = std::make_unique<Folder>();
        folder->path = pattern;
        return folder;
    }
    [[nodiscard]] bool write(const StartFileRecord& file) const {
        if (file.name.ends_with(unreadable_file)) {  // a folder is no file that anybody could read
            std::error_code failed;
            return fs::create_directory(path / file.name.substr(0, file.name.size() - unreadable_file.size()), failed);
        }
        std::ofstream out{path / file.name, std::ios::binary};
        for (const std::byte b : file.bytes) out.put(static_cast<char>(b));
        return out.flush().good();
    }
};

}  // namespace

struct Replay::Impl {
    Impl(RecordSource& from, StepReader&& start_records, const WireRecord& wire, const MachineConfig& config)
        : info(from.info()),
          steps(std::move(start_records)),
          transport(wire),
          stand_ins(config),
          again(one_step, Recorder::Policy::drop_newest),
          start{Duration{number_of(info, head_fact::start).value_or(0)}} {}

    [[nodiscard]] Step step();
    [[nodiscard]] Step malformed(Error why);
    /// Everything of this step that comes from outside goes in.
    [[nodiscard]] bool put(std::span<const RecordView> records);
    [[nodiscard]] bool put(const RecordView& record);
    [[nodiscard]] bool perform(const RecordView& record);
    void compare(std::span<const RecordView> records);

    std::unique_ptr<RecordSource> owned;
    const RecordingInfo& info;
    StepReader steps;
    std::unique_ptr<Folder> folder;
    ReplayTransport transport;
    StandIns stand_ins;
    Recorder again;
    std::unique_ptr<Machine> machine;
    bool armed = false;
    std::uint64_t cycles = 0, cycles_before = 0;
    Instant now{}, start{};
    Outcome then, now_made;  // as of the last step
    std::optional<ReplayDifference> difference;
    std::optional<Error> error;
};

Replay::Replay(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Replay::~Replay() = default;

Replay::Made Replay::make(MachineConfig config, RecordSource& recording) { return make(std::move(config), recording, nullptr); }
Replay::Made Replay::make(MachineConfig config, const Recording& recording) {
    auto source = std::make_unique<MemorySource>(recording);
    auto& from = *source;
    return make(std::move(config), from, std::move(source));
}

Replay::Made Replay::make(MachineConfig config, RecordSource& recording, std::unique_ptr<RecordSource> owned) {
    const auto refused = [](Error error) { return std::vector<Error>{std::move(error)}; };
    if (auto wrong = unfit(config, recording)) return refused(std::move(*wrong));
    const auto& info = recording.info();
    StepReader steps{recording};
    if (auto read = steps.read_start(); !read) return refused(std::move(read).error());
    const auto* found = first_of(steps.records(), wire_channel);
    const auto wire = found != nullptr ? read_wire(found->bytes) : std::nullopt;
    if (!wire) return refused({"replay.malformed", "recording", "it does not say what the machine was connected to", "use a backup"});

    config.retain.directory.clear();
    if (const auto* mode = find_fact(info, head_fact::mode); mode != nullptr)
        config.start_mode = *mode == "automatic" ? Mode::automatic : *mode == "setup" ? Mode::setup : Mode::manual;
    config.evidence.directory.clear();
    config.recording.directory.clear();
    std::unique_ptr<Folder> folder;
    if (const auto* retain = find_fact(info, head_fact::retain); retain != nullptr && *retain != "none") {
        folder = Folder::make();
        bool written = folder != nullptr;
        for (const auto& record : steps.records()) {
            if (record.channel != start_file_channel || !written) continue;
            const auto file = read_start_file(record.bytes);
            if (!file) return refused({"replay.malformed", "recording", "what the machine began with cannot be read", "use a backup"});
            written = folder->write(*file);
        }
        if (!written)
            return refused({"replay.folder", fs::temp_directory_path().string(), "there is no room for what the machine began with",
                            "make room, or set TMPDIR to another folder"});
        config.retain.directory = folder->path.string();
        config.retain.start = *retain == "cold" ? RetainStart::cold : *retain == "origin" ? RetainStart::origin : RetainStart::warm;
    }
    auto replay = std::make_unique<Impl>(recording, std::move(steps), *wire, config);
    replay->owned = std::move(owned);
    replay->folder = std::move(folder);
    auto built = Machine::build(std::move(config), replay->transport, replay->stand_ins.lines(), replay->stand_ins.exchanges());
    if (auto* errors = std::get_if<1>(&built)) return std::move(*errors);
    replay->machine = std::move(std::get<0>(built));
    const auto* threads = find_fact(info, head_fact::threads);
    const bool one = threads != nullptr && *threads == head_fact::one_thread;
    replay->machine->record(replay->again, one ? RecordedThreads::one : RecordedThreads::several);
    replay->machine->replayed().begin();
    replay->again.clear();  // the wire's
    return std::unique_ptr<Replay>{new Replay(std::move(replay))};
}

Replay::Step Replay::Impl::malformed(Error why) {
    error = std::move(why);
    return Step::malformed;
}

Replay::Step Replay::Impl::step() {
    const auto there = steps.next();
    if (!there) return malformed(there.error());
    if (!*there) return Step::ended;
    const auto records = steps.records();
    if (!put(records.subspan(1)) || !perform(records.front()))
        return malformed({"replay.malformed", "recording",
                          fmt::format("record {} ({:.6f} s) is not what this machine can have recorded", steps.first(),
                                      to_seconds(records.front().time - start)),
                          "it is of another machine file, or was altered"});
    transport.clear();
    difference.reset();
    compare(records);
    return difference ? Step::differs : Step::more;
}

bool Replay::Impl::put(std::span<const RecordView> records) {
    for (const auto& record : records)
        if (!put(record)) return false;
    machine->replayed().complete();
    return true;
}

bool Replay::Impl::put(const RecordView& record) {
    auto& inbox = machine->replayed();
    const auto into = [&inbox](const auto& read) { return read && inbox.put(*read); };
    if (ReplayTransport::is_mine(record.channel)) return transport.put(record);
    switch (record.channel) {
        case level_channel: return into(read_level(record.bytes));
        case command_channel: return into(read_command(record.bytes));
        case sample_channel: return into(read_sample(record.bytes));
        case modbus_request_channel: return into(read_request(record.bytes));
        case modbus_word_channel: return into(read_word(record.bytes));
        case disk_channel: return into(read_disk(record.bytes));
        case hook_channel: return into(read_hook(record.bytes));
        case task_times_channel: return into(read_task_times(record.bytes));
        case slow_channel: return into(read_slow(record.bytes));
        case faults_channel: return into(read_faults(record.bytes));
        case asked_channel: return into(read_asked(record.bytes));
        default: return true;  // what the machine makes of it
    }
}

bool Replay::Impl::perform(const RecordView& head) {
    if (head.channel == tick_channel) {
        const auto tick = read_tick(head.bytes);
        if (!tick) return false;
        ++(armed ? cycles : cycles_before);
        now = tick->scheduled;
        machine->cycle(*tick);
        return true;
    }
    const auto call = read_call(head.bytes);
    if (!call) return false;
    switch (call->call) {
        case Call::start_bus: machine->start_bus(); return true;
        case Call::stop_bus: machine->stop_bus(); return true;
        case Call::arm:
            if (armed) return false;
            armed = machine->arm().ok();  // whether it was is in the record, and compared
            return true;
        case Call::service: machine->service(call->now); return true;
        case Call::bus: machine->service_bus(call->now); return true;
        case Call::programs: machine->service_programs(); return true;
        case Call::slow_task: return call->index < machine->slow_task_count() && machine->run_slow_task(call->index);
        case Call::pump: machine->pump(call->now); return true;
    }
    return false;
}

void Replay::Impl::compare(std::span<const RecordView> records) {
    std::size_t at = 0;
    const auto differ = [&](const RecordView* recorded, const RecordView* replayed) {
        if (!difference) difference = difference_between(recorded, replayed);
    };
    for (const auto& record : records) then.take(record);
    again.drain([&](const RecordView& replayed) {
        now_made.take(replayed);
        if (at >= records.size()) return differ(nullptr, &replayed);
        const auto& recorded = records[at++];
        if (recorded.channel == replayed.channel && recorded.time == replayed.time && std::ranges::equal(recorded.bytes, replayed.bytes))
            return;
        differ(&recorded, &replayed);
    });
    if (at < records.size()) differ(&records[at], nullptr);
    if (!difference) return;
    // A set-point says more than the frame that carries it.
    if (auto named = difference_between(then, now_made, *machine)) difference = std::move(named);
    difference->cycle = armed ? cycles : 0;
    difference->at = now;
}

Replay::Step Replay::step() { return impl_->step(); }
Machine& Replay::machine() noexcept { return *impl_->machine; }
const std::optional<ReplayDifference>& Replay::difference() const noexcept { return impl_->difference; }
const std::optional<Error>& Replay::error() const noexcept { return impl_->error; }
std::uint64_t Replay::cycles() const noexcept { return impl_->cycles; }
std::uint64_t Replay::cycles_before() const noexcept { return impl_->cycles_before; }
Instant Replay::now() const noexcept { return impl_->now; }
Instant Replay::start() const noexcept { return impl_->start; }

}  // namespace taktwerk::runtime
