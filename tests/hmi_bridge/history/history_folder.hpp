#pragma once
// A folder of a test's own, and rows to put into a history.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "hmi_bridge/history/alarm_watch.hpp"

namespace taktwerk::hmi::test {

class HistoryFolder {
public:
    HistoryFolder() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-history-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data());
    }
    ~HistoryFolder() {
        std::error_code ignored;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(path_, ignored);
    }
    HistoryFolder(const HistoryFolder&) = delete;
    HistoryFolder& operator=(const HistoryFolder&) = delete;
    [[nodiscard]] std::string file() const { return path_ + "/demo.alarms.sqlite"; }
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

inline AlarmWatch::Change raised(std::uint64_t key, std::int64_t utime, const std::string& name = "following_error",
                                 const std::string& source = "axis x") {
    AlarmWatch::Change change;
    change.key = key;
    change.row.utime = utime;
    change.row.alarm = 0x3001;
    change.row.reaction = Reaction::stop_axis;
    change.row.name = name;
    change.row.source = source;
    change.row.english = "The axis lags behind by " + std::to_string(key) + " mm";
    change.row.chinese = "跟随误差过大";
    change.row.cause = "It is blocked";
    change.row.remedy = "Free it";
    return change;
}

}  // namespace taktwerk::hmi::test
