#include "modbus/tcp/device_poller.hpp"

#include <algorithm>
#include <utility>

#include "modbus/tcp/channel_words.hpp"

namespace taktwerk::modbus::tcp {

DevicePoller::DevicePoller(DeviceConfig device, Exchange& exchange, std::vector<std::int64_t> outputs)
    : device_(std::move(device)),
      exchange_(exchange),
      requests_(plan_requests(device_)),
      progress_(requests_.size()),
      words_(device_.channels.size()),
      reports_(Report{words_, std::vector<RequestState>(requests_.size())}),
      outputs_(outputs) {
    for (const auto& request : requests_) first_read_ += request.write ? 1 : 0;
    next_read_ = requests_.size();
}

void DevicePoller::put(std::span<const std::int64_t> words) noexcept {
    std::ranges::copy(words, outputs_.back().begin());
    outputs_.publish();
}

void DevicePoller::step(Instant now) {
    if (requests_.empty()) return;
    if (!exchange_.connected()) {
        if (now >= next_attempt_) connect(now);
        return;
    }
    if (next_read_ == requests_.size() && now >= next_poll_) {
        next_read_ = first_read_;
        next_poll_ = std::max(next_poll_ + device_.poll, now);  // late polls are not caught up
    }
    const bool to_read = next_read_ < requests_.size();
    // Outputs that change all the time leave every other turn to the inputs.
    for (std::size_t k = 0; k < first_read_ && !(wrote_last_ && to_read); ++k) {
        const auto i = (next_write_ + k) % first_read_;
        if (!to_write(i, now)) continue;
        const auto fault = write(i, now);
        wrote_last_ = !answers_once(fault);
        next_write_ = answers_once(fault) ? i : i + 1;
        return note(i, now, fault);
    }
    wrote_last_ = false;
    if (!to_read) return;
    const auto request = next_read_++;
    const auto fault = read(request);
    if (answers_once(fault)) {
        wrote_last_ = true;
        next_read_ = request;
    }
    note(request, now, fault);
}

/// Some end the connection behind each answer: what came to nothing has the first turn in the next one.
bool DevicePoller::answers_once(Fault fault) const noexcept { return fault.ends_connection() && answered_ == 1; }

bool DevicePoller::finish(Instant now) {
    for (std::size_t i = 0; i < first_read_ && exchange_.connected(); ++i) {
        encode(requests_[i]);
        if (values_ == progress_[i].written) continue;
        const auto fault = write(i, now);
        note(i, now, fault);
        if (fault) break;
        return true;
    }
    exchange_.close();
    return false;
}

void DevicePoller::connect(Instant now) {
    const auto fault = exchange_.connect();
    // A device that lets itself be connected and then says nothing has not come back: the pause begins anew when a request succeeds.
    next_attempt_ = now + pause_;
    pause_ = std::min(pause_ * 2, longest_pause);
    if (fault) {
        for (auto& progress : progress_) progress.state.fault = fault;
        publish();
        return;
    }
    // Who was away may have lost everything: outputs first, all of them.
    for (auto& progress : progress_) progress.written.clear(), progress.due = now;
    if (answered_ != 1) next_read_ = requests_.size();
    answered_ = 0;
    next_poll_ = now;
}

void DevicePoller::encode(const Request& request) {
    const auto& words = *outputs_.read().value;
    values_.assign(request.count, 0);
    for (const auto i : request.channels) {
        const auto& channel = device_.channels[i];
        put_word(channel, words[i],
                 std::span{values_}.subspan(static_cast<std::size_t>(channel.address - request.address), addresses_of(channel.type)));
    }
}

bool DevicePoller::to_write(std::size_t request, Instant now) {
    auto& progress = progress_[request];
    if (now >= progress.due) return true;
    if (progress.state.fault) return false;  // refused: not again before it is due
    encode(requests_[request]);
    return values_ != progress.written;
}

Fault DevicePoller::write(std::size_t request, Instant now) {
    auto& progress = progress_[request];
    encode(requests_[request]);
    progress.due = now + device_.refresh;
    const auto fault = exchange_.write(requests_[request].table, requests_[request].address, values_);
    if (!fault) progress.written = values_;
    return fault;
}

Fault DevicePoller::read(std::size_t request) {
    const auto& wanted = requests_[request];
    values_.assign(wanted.count, 0);
    const auto fault = exchange_.read(wanted.table, wanted.address, values_);
    if (fault) return fault;
    for (const auto i : wanted.channels) {
        const auto& channel = device_.channels[i];
        words_[i] = word_of(
            channel, std::span{values_}.subspan(static_cast<std::size_t>(channel.address - wanted.address), addresses_of(channel.type)));
    }
    return fault;
}

/// The time is that of the request, not of its answer: a value is as old as it can be at most.
void DevicePoller::note(std::size_t request, Instant now, Fault fault) {
    auto& state = progress_[request].state;
    state.fault = fault;
    if (!fault) {
        state.done = now;
        state.ever = true;
        ++answered_;
        pause_ = shortest_pause;
    }
    if (fault.ends_connection()) {
        for (auto& progress : progress_) progress.state.fault = fault;
        exchange_.close();
        next_attempt_ = now + pause_;
        pause_ = std::min(pause_ * 2, longest_pause);
    }
    publish();
}

void DevicePoller::publish() {
    auto& report = reports_.back();
    report.words = words_;
    for (std::size_t i = 0; i < progress_.size(); ++i) report.requests[i] = progress_[i].state;
    reports_.publish();
}

}  // namespace taktwerk::modbus::tcp
