#include "apps/machine/machine_recording.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "core/crc32.hpp"
#include "programs/api/abi.hpp"
#include "runtime/recording/inbox_record.hpp"
#include "runtime/recording/outcome_record.hpp"
#include "runtime/replay/recording_head.hpp"
#include "runtime/tasks/shared_object_check.hpp"

namespace taktwerk::apps {

namespace {

namespace fs = std::filesystem;

std::string check_sum(std::uint32_t crc, std::size_t size) { return fmt::format("crc32 {:08x}, {} bytes", crc, size); }

std::string check_sum_of(const std::string& path) {
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    const std::unique_ptr<std::FILE, Close> file{std::fopen(path.c_str(), "rbe")};
    if (file == nullptr) return "not readable";
    std::uint32_t crc = 0;
    std::size_t size = 0;
    std::array<std::byte, 65536> block;
    while (const std::size_t got = std::fread(block.data(), 1, block.size(), file.get())) {
        crc = crc32(std::span{block}.first(got), crc);
        size += got;
    }
    return check_sum(crc, size);
}

/// taktwerk is large: what its linker has made of all of it does as well as a sum.
std::string this_binary() {
    const std::string self = "/proc/self/exe";
    const auto id = runtime::build_id_of(self);
    return id.empty() ? check_sum_of(self) : "build " + id;
}

/// The machine file may be called anything and stand anywhere; of the others the folder says what they are.
std::string name_of(const fs::path& path, bool is_machine) {
    return is_machine ? std::string("of the machine") : (path.parent_path().filename() / path.filename()).string();
}

}  // namespace

std::vector<std::pair<std::string, std::string>> facts_of(const std::string& machine_file, const config::FilesRead& files,
                                                          const runtime::MachineConfig& config, bool simulated) {
    std::vector<std::pair<std::string, std::string>> facts;
    const auto add = [&facts](std::string_view prefix, const std::string& name, std::string value) {
        facts.emplace_back(std::string(prefix) + name, std::move(value));
    };
    using namespace runtime::head_fact;
    add(version, "", sdk_version);
    add(binary, "", this_binary());
    std::error_code unknown;
    const auto absolute = fs::absolute(machine_file, unknown);
    add("machine_file", "", unknown ? machine_file : absolute.string());
    add("simulated", "", simulated ? "yes" : "no");
    for (std::size_t i = 0; i < files.files().size(); ++i) {
        const auto& file = files.files()[i];
        add(file_prefix, name_of(file.path, i == 0), check_sum(file.crc, file.size));
    }
    for (const auto& program : config.programs)
        if (!program.library.empty()) add(program_prefix, program.name, check_sum_of(program.library));
    return facts;
}

std::optional<MachineRecording::Memory> MachineRecording::memory_of(const runtime::MachineConfig& config, Instant start, Duration epoch,
                                                                    runtime::RecordedThreads threads) {
    const auto& recording = config.recording;
    const bool no_time = config.realtime.required || config.cycle < std::chrono::milliseconds{1} || !config.axis_groups.empty();
    if (threads == runtime::RecordedThreads::several && no_time) return std::nullopt;
    if (!recording.replay || recording.directory.empty() || recording.files == 0) return std::nullopt;
    constexpr std::uint64_t megabyte = 1'000'000;
    return Memory{{config.name, recording.directory, start, epoch, recording.after},
                  {recording.replay_memory * megabyte, recording.replay_disk * megabyte, recording.files}};
}

MachineRecording::MachineRecording() : recorder_(ring_bytes, Recorder::Policy::drop_newest), packer_(runtime::tick_channel) {}

Result<std::unique_ptr<MachineRecording>> MachineRecording::create(const Wanted& wanted, runtime::Machine& machine,
                                                                   std::vector<std::pair<std::string, std::string>> facts, Instant start,
                                                                   runtime::RecordedThreads threads) {
    auto info = runtime::recording_info(machine.config(), start, threads);
    info.facts.insert(info.facts.end(), std::make_move_iterator(facts.begin()), std::make_move_iterator(facts.end()));
    std::unique_ptr<MachineRecording> recording{new MachineRecording};
    if (wanted.memory) {
        auto opened = runtime::RunMemory::open(info, wanted.memory->place, wanted.memory->room);
        if (!opened) return std::move(opened).error();
        recording->memory_ = std::move(*opened);
    }
    if (!wanted.file.path.empty()) {
        auto writer = runtime::RecordingWriter::create(wanted.file.path, std::move(info), wanted.file.room);
        if (!writer) return std::move(writer).error();
        recording->writer_ = std::move(*writer);
    }
    for (const auto& kept : runtime::start_files(machine.config()))
        recording->take({runtime::start_file_channel, start, runtime::start_file_record(kept)});
    machine.record(recording->recorder_, threads);
    return recording;
}

void MachineRecording::take(const RecordView& record) {
    if (packer_.records() == 0) block_began_ = record.time;
    packer_.add(record);
    last_ = std::max(last_, record.time);
    if (packer_.full() || record.time - block_began_ >= block_time) take_block();
}

void MachineRecording::take_block() {
    const auto records = packer_.records();
    if (records == 0) return;
    runtime::PackedBlock block{packer_.take(), records};
    if (writer_ && !broken_) {
        if (auto done = writer_->write(block); !done) broken_ = done.error();
        if (broken_ && broken_->code == "recording.limit") (void)writer_->finish(runtime::RecordingEnd::limit, recorder_.dropped()).ok();
    }
    if (memory_) memory_->take(std::move(block), last_, recorder_.dropped());
}

std::optional<Error> MachineRecording::drain() {
    const bool was_broken = broken_.has_value();
    recorder_.drain([this](const RecordView& record) { take(record); });
    return was_broken ? std::nullopt : broken_;
}

Result<void> MachineRecording::finish() {
    (void)drain();
    take_block();
    if (!writer_) return {};
    if (broken_ && broken_->code == "recording.limit") return {};  // as it was told to, and it was said
    if (broken_) return *broken_;
    return writer_->finish(runtime::RecordingEnd::whole, recorder_.dropped());
}

}  // namespace taktwerk::apps
