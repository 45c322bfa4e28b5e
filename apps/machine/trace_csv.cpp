#include "apps/machine/trace_csv.hpp"

#include <cerrno>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

struct Quantity {
    std::string_view column, per;
};
constexpr Quantity quantities[] = {{"set_position", ""},    {"set_velocity", "/s"},  {"set_acceleration", "/s2"},
                                   {"set_jerk", "/s3"},     {"actual_position", ""}, {"actual_velocity", "/s"},
                                   {"following_error", ""}, {"target_position", ""}};

/// "[mm/s]" for the columns of an axis that have its unit and for those of a group, empty for others.
std::string unit_of(const runtime::RecordedSignal& signal, const runtime::MachineLayout& layout) {
    const std::string_view column = signal.name;
    if (signal.group == runtime::SignalGroup::group && !signal.unit.empty()) return "[" + signal.unit + "]";
    for (const auto& axis : layout.axes)
        for (const auto& quantity : quantities)
            if (column == fmt::format("{}.{}", axis.name, quantity.column)) return fmt::format("[{}{}]", axis.unit, quantity.per);
    return {};
}

}  // namespace

TraceCsv::TraceCsv(std::string path, std::FILE* file, runtime::SignalRing& ring) : path_(std::move(path)), file_(file), rows_(ring) {
    for (const auto& signal : ring.signals())
        if (signal.in_trace) columns_.push_back(signal.cell);
}

Result<std::unique_ptr<TraceCsv>> TraceCsv::create(const std::string& path, runtime::SignalRing& ring,
                                                   const runtime::MachineLayout& layout) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file)
        return Error{"trace.create", path, fmt::format("the trace cannot be written: {}", std::strerror(errno)),
                     "choose another place for --trace"};
    std::setvbuf(file, nullptr, _IOFBF, 1 << 20);
    auto trace = std::unique_ptr<TraceCsv>(new TraceCsv(path, file, ring));
    std::string header;
    for (const auto& signal : ring.signals())
        if (signal.in_trace) header += (header.empty() ? "" : ",") + signal.name + unit_of(signal, layout);
    header += '\n';
    std::fwrite(header.data(), 1, header.size(), file);
    return trace;
}

TraceCsv::~TraceCsv() {
    if (file_) std::fclose(file_);
}

Result<void> TraceCsv::drain() {
    const bool was_broken = broken_.has_value();
    for (auto row = rows_.next(); !row.empty(); row = rows_.next()) {
        line_.clear();
        auto out = std::back_inserter(line_);
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (i > 0) line_ += ',';
            const double shown = columns_[i].value_of(row[columns_[i].word]), value = i == 0 ? shown - start_s_ : shown;
            // Whole numbers (states, switches, bits) are most of a trace: the short way is also the fast one.
            if (value > -1e15 && value < 1e15 && value == static_cast<double>(static_cast<long long>(value)))
                out = fmt::format_to(out, "{}", static_cast<long long>(value));
            else out = fmt::format_to(out, "{}", value);
        }
        line_ += '\n';
        if (!broken_ && std::fwrite(line_.data(), 1, line_.size(), file_) != line_.size()) broken_ = failure();
    }
    if (broken_ && !was_broken) return *broken_;
    return {};
}

Error TraceCsv::failure() const {
    return {"trace.write", path_, fmt::format("the trace is not complete: {}", std::strerror(errno)), "look for free space on that disk"};
}

Result<void> TraceCsv::finish() {
    (void)drain().ok();
    if (!broken_ && std::fflush(file_) != 0) broken_ = failure();
    std::fclose(file_);
    file_ = nullptr;
    if (broken_) return *broken_;
    return {};
}

}  // namespace taktwerk::apps
