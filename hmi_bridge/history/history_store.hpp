#pragma once
// The file of the history. Every call may wait for a disk. One thread, not real-time.
//
// Write-ahead log, each transaction on the disk before the call returns: a power cut or kill -9 costs at most what was not handed over yet, and never the
// file. (A rollback journal would be as safe and wait for the disk three times instead of once.) The file belongs to one process while it is open.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/result.hpp"
#include "hmi_bridge/history/alarm_row.hpp"
#include "hmi_bridge/history/alarm_watch.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace taktwerk::hmi {

class HistoryStore {
public:
    static constexpr std::size_t longest_text = 2000;  ///< bytes of each text; what is longer is cut

    struct Opened {
        std::unique_ptr<HistoryStore> store;
        std::string moved_aside;  ///< the file was no history, or torn: what had its name stands here now; empty: all was well
    };
    /// Makes the folder and the file where they are missing. `rows`: at least 1. `run`: of this process; 0: a new one, and what was listed when the last
    /// one ended is `unknown` from now on. Errors: history.folder, history.open, history.in_use.
    [[nodiscard]] static Result<Opened> open(const std::string& path, std::int64_t rows, std::int64_t run = 0);
    ~HistoryStore();
    HistoryStore(const HistoryStore&) = delete;
    HistoryStore& operator=(const HistoryStore&) = delete;

    [[nodiscard]] std::int64_t run() const noexcept { return run_; }

    /// All of them or none; the oldest rows go where there are more than `rows`. Errors: history.write, history.torn (open it anew).
    [[nodiscard]] Result<void> write(std::span<const AlarmWatch::Change> changes);
    /// Errors: history.read, history.torn.
    [[nodiscard]] Result<HistoryPage> read(const HistoryQuery& query);

private:
    HistoryStore(std::string path, std::int64_t rows, std::int64_t run, sqlite3* file)
        : path_(std::move(path)), rows_(rows), run_(run), file_(file) {}
    [[nodiscard]] Result<void> prepare();
    [[nodiscard]] Result<void> put(const AlarmWatch::Change& change);
    [[nodiscard]] Error failed(std::string code, std::string_view doing) const;
    bool execute(const std::string& sql);

    std::string path_;
    std::int64_t rows_, run_;
    sqlite3* file_;
    sqlite3_stmt *insert_ = nullptr, *update_ = nullptr, *prune_ = nullptr, *select_ = nullptr;
};

}  // namespace taktwerk::hmi
