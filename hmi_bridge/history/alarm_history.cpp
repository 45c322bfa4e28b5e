#include "hmi_bridge/history/alarm_history.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::hmi {

AlarmHistory::AlarmHistory(std::string path, std::int64_t rows, AlarmWatch::Describe describe, std::function<void(std::string_view)> log)
    : path_(std::move(path)), rows_(rows), log_(std::move(log)), watch_(std::move(describe)) {
    if (!log_) log_ = [](std::string_view) {};
}

void AlarmHistory::look(const runtime::Snapshot& snapshot, Instant now, std::int64_t utime) {
    auto changes = watch_.look(snapshot, now, utime);
    if (const auto missed = watch_.missed(); missed != said_missed_) {
        log_(fmt::format("{} alarms came and went too fast to be seen: the alarm history has only their number", missed - said_missed_));
        said_missed_ = missed;
    }
    if (changes.empty()) return;
    const std::lock_guard lock{mutex_};
    for (auto& change : changes) {
        if (waiting_.size() < most_waiting || waiting_.find(change.key) != waiting_.end()) {
            waiting_[change.key] = std::move(change.row);
        } else if (change.key > last_dropped_) {  // each once, also where its end finds no room either
            last_dropped_ = change.key;
            ++dropped_;
        }
    }
}

void AlarmHistory::ask(std::uint64_t tag, std::string id, HistoryQuery query, Instant now) {
    if (asked_.size() >= most_questions) {
        refused_.push_back({tag, std::move(id),
                            Error{"command.queue_full", "", fmt::format("{} questions to the alarm history are under way", most_questions),
                                  "Wait for an answer, then give it again."}});
        return;
    }
    const auto number = next_question_++;
    asked_[number] = {tag, std::move(id), now};
    const std::lock_guard lock{mutex_};
    questions_.push_back({number, std::move(query)});
}

std::optional<AlarmHistory::Answer> AlarmHistory::next_answer(Instant now) {
    if (!refused_.empty()) {
        auto answer = std::move(refused_.front());
        refused_.pop_front();
        return answer;
    }
    if (asked_.empty()) return std::nullopt;
    std::unique_lock lock{mutex_};
    while (!answered_.empty()) {
        auto answered = std::move(answered_.front());
        answered_.pop_front();
        const auto asked = asked_.find(answered.number);
        if (asked == asked_.end()) continue;  // too late
        Answer answer{asked->second.tag, std::move(asked->second.id), std::move(answered.page)};
        asked_.erase(asked);
        return answer;
    }
    const auto oldest = asked_.begin();
    if (now - oldest->second.since < patience) return std::nullopt;
    std::erase_if(questions_, [&](const Question& question) { return question.number == oldest->first; });
    Answer answer{oldest->second.tag, std::move(oldest->second.id),
                  Error{"history.silent", path_, fmt::format("the disk has not come back for {:.0f} s", to_seconds(patience)),
                        "Look at that disk; the machine does not wait for it."}};
    asked_.erase(oldest);
    return answer;
}

void AlarmHistory::fail(const Error& error, Instant now) {
    if (!trouble_ || trouble_->code != error.code)
        log_(fmt::format("{} The machine runs on; it is tried again each {:.0f} s.", error.text(), to_seconds(again)));
    trouble_ = error;
    // What a full disk has can still be read; before the next write it is opened anew.
    if (error.code != "history.write") store_.reset();
    next_try_ = now + again;
}

bool AlarmHistory::open() {
    if (store_) return true;
    if (trouble_ && now_ < next_try_) return false;
    auto opened = HistoryStore::open(path_, rows_, run_);
    if (!opened) {
        fail(opened.error(), now_);
        return false;
    }
    store_ = std::move(opened->store);
    run_ = store_->run();
    if (!opened->moved_aside.empty())
        log_(fmt::format("{} was torn, or no alarm history: it is {} now, and a new one begins", path_, opened->moved_aside));
    return true;
}

bool AlarmHistory::write(Instant now) {
    Waiting taken;
    std::uint64_t dropped = 0;
    {
        const std::lock_guard lock{mutex_};
        taken.swap(waiting_);
        dropped = dropped_;
    }
    if (taken.empty()) return true;
    Result<void> written;
    if (trouble_) store_.reset();
    if (open()) {
        std::vector<AlarmWatch::Change> changes;
        changes.reserve(taken.size());
        for (const auto& [key, row] : taken) changes.push_back({key, row});
        written = store_->write(changes);
        if (!written && written.error().code == "history.torn") {  // torn while it was open: the next open() moves it aside
            store_.reset();
            if (open()) written = store_->write(changes);
        }
        if (!written) fail(written.error(), now);
    }
    if (store_ && written) {
        next_write_ = now + together;
        if (trouble_ || dropped != said_dropped_)
            log_(fmt::format("{} is written{}{}", path_, trouble_ ? " again" : "",
                             dropped == said_dropped_ ? std::string{}
                                                      : fmt::format("; {} alarms found no room and are missing", dropped - said_dropped_)));
        trouble_.reset();
        said_dropped_ = dropped;
        return true;
    }
    const std::lock_guard lock{mutex_};
    for (auto& [key, row] : taken) waiting_.try_emplace(key, std::move(row));  // what has changed meanwhile is newer
    return false;
}

Result<HistoryPage> AlarmHistory::read(const HistoryQuery& query, Instant now) {
    std::error_code unknown;
    if (!store_ && !trouble_ && !std::filesystem::exists(path_, unknown)) return HistoryPage{};  // there never was an alarm
    if (!open()) return *trouble_;
    auto page = store_->read(query);
    if (!page && page.error().code == "history.torn") fail(page.error(), now);
    return page;
}

void AlarmHistory::work(Instant now) {
    now_ = now;
    std::deque<Question> questions;
    bool waits = false;
    {
        const std::lock_guard lock{mutex_};
        questions.swap(questions_);
        waits = !waiting_.empty();
    }
    const bool due = trouble_ ? now >= next_try_ : now >= next_write_;
    if (waits && (due || (!questions.empty() && !trouble_))) write(now);
    for (const auto& question : questions) {
        auto page = read(question.query, now);
        const std::lock_guard lock{mutex_};
        answered_.push_back({question.number, std::move(page)});
    }
}

void AlarmHistory::finish(Instant now) {
    now_ = next_try_ = now;
    write(now);
    store_.reset();
}

}  // namespace taktwerk::hmi
