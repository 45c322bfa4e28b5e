#include "runtime/replay/step_reader.hpp"

#include "runtime/recording/inbox_record.hpp"
#include "runtime/recording/outcome_record.hpp"

namespace taktwerk::runtime {

bool StepReader::begins_a_step(RecordChannel channel) noexcept { return channel == tick_channel || channel == call_channel; }

void StepReader::keep(const RecordView& record) {
    places_.push_back({record.channel, record.time, bytes_.size(), record.bytes.size()});
    bytes_.insert(bytes_.end(), record.bytes.begin(), record.bytes.end());
}

/// Up to the record that begins the next step, which waits then.
Result<void> StepReader::read() {
    has_next_ = false;
    for (;;) {
        auto record = source_.next();
        if (!record) return std::move(record).error();
        if (!record->has_value()) break;
        if (begins_a_step((*record)->channel)) {
            next_bytes_.assign((*record)->bytes.begin(), (*record)->bytes.end());
            next_ = {(*record)->channel, (*record)->time, next_bytes_};
            has_next_ = true;
            break;
        }
        keep(**record);
    }
    records_.clear();
    for (const auto& place : places_)
        records_.push_back({place.channel, place.time, std::span{bytes_}.subspan(place.offset, place.length)});
    return {};
}

Result<bool> StepReader::next() {
    first_ += records_.size();
    places_.clear();
    bytes_.clear();
    records_.clear();
    if (!has_next_) return false;
    keep(next_);
    if (auto done = read(); !done) return std::move(done).error();
    if (!has_next_ && source_.end() != RecordingEnd::whole) {
        records_.clear();
        return false;
    }
    return true;
}

}  // namespace taktwerk::runtime
