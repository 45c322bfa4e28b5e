#include "runtime/replay/recording_head.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "runtime/recording/outcome_record.hpp"
#include "runtime/retain/slot_files.hpp"

namespace taktwerk::runtime {

namespace {

std::string_view name_of(RetainStart start) {
    switch (start) {
        case RetainStart::warm: return "warm";
        case RetainStart::cold: return "cold";
        case RetainStart::origin: break;
    }
    return "origin";
}

/// "program 'cell'", "file drives/sv33-e.yaml"; empty: no fact that two runs of one machine share.
std::string subject_of(std::string_view fact) {
    if (fact.starts_with(head_fact::program_prefix)) return fmt::format("program '{}'", fact.substr(head_fact::program_prefix.size()));
    if (fact.starts_with(head_fact::file_prefix)) return fmt::format("file {}", fact.substr(head_fact::file_prefix.size()));
    if (fact == head_fact::binary) return "taktwerk itself";
    if (fact == head_fact::version) return "the version of taktwerk";
    return {};
}

}  // namespace

RecordingInfo recording_info(const MachineConfig& config, Instant start, RecordedThreads threads) {
    RecordingInfo info{inbox_channels(), {}};
    const auto add = [&info](std::string_view name, std::string value) { info.facts.emplace_back(name, std::move(value)); };
    add(head_fact::machine, config.name);
    add(head_fact::cycle, std::to_string(config.cycle.count()));
    add(head_fact::start, std::to_string(start.time_since_epoch().count()));
    add(head_fact::threads, threads == RecordedThreads::one ? std::string(head_fact::one_thread) : "several");
    // Which one the file asks for is another thing: behind a crash a machine begins in manual mode (docs/service.md).
    add(head_fact::mode, config.start_mode == Mode::automatic ? "automatic" : config.start_mode == Mode::setup ? "setup" : "manual");
    add(head_fact::retain, config.retain.empty() ? "none" : std::string(name_of(config.retain.start)));
    return info;
}

const std::string* find_fact(const RecordingInfo& info, std::string_view name) noexcept {
    const auto found = std::ranges::find(info.facts, name, [](const auto& fact) -> std::string_view { return fact.first; });
    return found != info.facts.end() ? &found->second : nullptr;
}

std::vector<StartFile> start_files(const MachineConfig& config) {
    std::vector<StartFile> out;
    if (config.retain.empty()) return out;
    const std::filesystem::path folder{config.retain.directory};
    for (const char* name : {"retain.0", "retain.1", "positions.0", "positions.1"}) {
        auto text = SlotFiles::read(folder / name);
        if (!text) out.push_back({std::string(name).append(unreadable_file), {}});  // that it is there is an alarm
        else if (text->has_value()) out.push_back({name, std::move(**text)});
    }
    return out;
}

std::vector<std::byte> start_file_record(const StartFile& file) {
    std::vector<std::byte> record(2);
    store_le(std::span{record}, 0, static_cast<std::uint16_t>(file.name.size()));
    for (const auto* text : {&file.name, &file.bytes}) {
        const auto bytes = std::as_bytes(std::span{text->data(), text->size()});
        record.insert(record.end(), bytes.begin(), bytes.end());
    }
    return record;
}

std::vector<std::string> other_facts(const RecordingInfo& then, const RecordingInfo& now) {
    std::vector<std::string> out;
    for (const auto& [name, value] : then.facts) {
        const auto subject = subject_of(name);
        if (subject.empty()) continue;
        const auto* here = find_fact(now, name);
        if (here == nullptr) out.push_back(fmt::format("{} was there when this was recorded, and is not now", subject));
        else if (*here != value) out.push_back(fmt::format("{} is another one: {} when this was recorded, {} now", subject, value, *here));
    }
    for (const auto& [name, value] : now.facts)
        if (const auto subject = subject_of(name); !subject.empty() && find_fact(then, name) == nullptr)
            out.push_back(fmt::format("{} is there now, and was not when this was recorded", subject));
    return out;
}

}  // namespace taktwerk::runtime
