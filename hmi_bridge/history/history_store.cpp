#include "hmi_bridge/history/history_store.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::hmi {
namespace {

namespace fs = std::filesystem;

constexpr int version = 1;  // of the table; another one is another program's file
constexpr int patience_ms = 1000;
constexpr const char* set_up =
    "PRAGMA locking_mode=EXCLUSIVE; PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA journal_size_limit=4194304; "
    "PRAGMA trusted_schema=OFF;";
constexpr const char* make_table =
    "BEGIN IMMEDIATE;"
    "CREATE TABLE alarms(id INTEGER PRIMARY KEY AUTOINCREMENT, utime INTEGER NOT NULL, cleared_utime INTEGER NOT NULL,"
    " acknowledged_utime INTEGER NOT NULL, state INTEGER NOT NULL, alarm INTEGER NOT NULL, count INTEGER NOT NULL, reaction INTEGER NOT "
    "NULL,"
    " name TEXT NOT NULL, source TEXT NOT NULL, english TEXT NOT NULL, chinese TEXT NOT NULL, cause TEXT NOT NULL, remedy TEXT NOT NULL,"
    " manual TEXT NOT NULL, recording TEXT NOT NULL, run INTEGER NOT NULL, key INTEGER NOT NULL, UNIQUE(run, key)) STRICT;"
    "PRAGMA user_version=1;"
    "COMMIT;";
constexpr const char* insert_row =
    "INSERT INTO alarms(utime,cleared_utime,acknowledged_utime,state,alarm,count,reaction,name,source,english,chinese,cause,remedy,manual,"
    "recording,run,key) VALUES(?1,?2,?3,?4,?5,?6,?7,?8,?9,?10,?11,?12,?13,?14,?15,?16,?17)";
constexpr const char* update_row =
    "UPDATE alarms SET "
    "utime=?1,cleared_utime=?2,acknowledged_utime=?3,state=?4,alarm=?5,count=?6,reaction=?7,name=?8,source=?9,english=?10,"
    "chinese=?11,cause=?12,remedy=?13,manual=?14,recording=?15 WHERE run=?16 AND key=?17";
constexpr const char* prune_rows = "DELETE FROM alarms WHERE id <= (SELECT max(id) FROM alarms) - ?1";
constexpr const char* select_rows =
    "SELECT id,utime,cleared_utime,acknowledged_utime,state,alarm,count,reaction,name,source,english,chinese,cause,remedy,manual,recording"
    " FROM alarms WHERE id < ?1 AND utime >= ?2 AND utime <= ?3 AND (?4 = '' OR source = ?4) AND (?5 = '' OR name LIKE ?5 ESCAPE '\\'"
    " OR source LIKE ?5 ESCAPE '\\' OR english LIKE ?5 ESCAPE '\\' OR chinese LIKE ?5 ESCAPE '\\' OR cause LIKE ?5 ESCAPE '\\'"
    " OR remedy LIKE ?5 ESCAPE '\\') ORDER BY id DESC LIMIT ?6";

/// Not in the middle of a character.
std::string_view cut(std::string_view text) {
    if (text.size() <= HistoryStore::longest_text) return text;
    auto end = HistoryStore::longest_text;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return text.substr(0, end);
}

void bind_text(sqlite3_stmt* statement, int at, std::string_view text) {
    // An empty view may have no address, which SQLite takes for NULL.
    sqlite3_bind_text64(statement, at, text.empty() ? "" : text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
}

void bind_row(sqlite3_stmt* statement, const AlarmRow& row) {
    sqlite3_bind_int64(statement, 1, row.utime);
    sqlite3_bind_int64(statement, 2, row.cleared_utime);
    sqlite3_bind_int64(statement, 3, row.acknowledged_utime);
    sqlite3_bind_int64(statement, 4, static_cast<int>(row.state));
    sqlite3_bind_int64(statement, 5, row.alarm);
    sqlite3_bind_int64(statement, 6, row.count);
    sqlite3_bind_int64(statement, 7, static_cast<int>(row.reaction));
    int at = 8;
    for (const auto* text : {&row.name, &row.source, &row.english, &row.chinese, &row.cause, &row.remedy, &row.manual, &row.recording})
        bind_text(statement, at++, cut(*text));
}

/// The file may be foreign: every number is brought into its range.
AlarmRow row_of(sqlite3_stmt* statement) {
    const auto number = [&](int column, std::int64_t most) {
        return std::clamp<std::int64_t>(sqlite3_column_int64(statement, column), 0, most);
    };
    AlarmRow row;
    row.id = sqlite3_column_int64(statement, 0);
    row.utime = number(1, INT64_MAX);
    row.cleared_utime = number(2, INT64_MAX);
    row.acknowledged_utime = number(3, INT64_MAX);
    row.state = static_cast<AlarmState>(number(4, static_cast<int>(AlarmState::unknown)));
    row.alarm = static_cast<AlarmId>(number(5, UINT16_MAX));
    row.count = static_cast<std::uint32_t>(number(6, UINT32_MAX));
    row.reaction = static_cast<Reaction>(number(7, static_cast<int>(Reaction::power_off)));
    int column = 8;
    for (auto* text : {&row.name, &row.source, &row.english, &row.chinese, &row.cause, &row.remedy, &row.manual, &row.recording}) {
        const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
        const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, column++));
        if (bytes != nullptr) text->assign(cut({bytes, size}));
    }
    return row;
}

/// `text` itself, whatever stands in it.
std::string anywhere(std::string_view text) {
    if (text.empty()) return {};
    std::string out = "%";
    for (const char c : text) {
        if (c == '%' || c == '_' || c == '\\') out += '\\';
        out += c;
    }
    return out + "%";
}

bool is_torn(int code) {
    const int plain = code & 0xFF;
    return plain == SQLITE_CORRUPT || plain == SQLITE_NOTADB || plain == SQLITE_MISMATCH || plain == SQLITE_SCHEMA;
}

/// One number, or nothing.
bool ask(sqlite3* file, const char* sql, std::string& answer) {
    sqlite3_stmt* statement = nullptr;
    bool got = sqlite3_prepare_v2(file, sql, -1, &statement, nullptr) == SQLITE_OK && sqlite3_step(statement) == SQLITE_ROW;
    if (got) answer = reinterpret_cast<const char*>(sqlite3_column_text(statement, 0));
    sqlite3_finalize(statement);
    return got;
}

/// What had the history's name gets another; one of them is kept, the newest.
std::string move_aside(const std::string& path) {
    std::error_code failed;
    const auto aside = path + ".torn";
    for (const char* end : {"-wal", "-shm", ""}) {
        fs::remove(aside + end, failed);
        if (fs::exists(path + end, failed)) fs::rename(path + end, aside + end, failed);
    }
    return failed ? std::string{} : aside;
}

}  // namespace

Result<HistoryStore::Opened> HistoryStore::open(const std::string& path, std::int64_t rows, std::int64_t run) {
    std::error_code failed;
    const auto folder = fs::path(path).parent_path();
    fs::create_directories(folder, failed);
    if (failed && !fs::is_directory(folder))
        return Error{"history.folder", folder.string(), fmt::format("the folder of the alarm history cannot be made: {}", failed.message()),
                     "Give another one: `history: {directory: ...}`."};
    Opened out;
    for (const bool first : {true, false}) {
        sqlite3* file = nullptr;
        const int code = sqlite3_open_v2(path.c_str(), &file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
        out.store.reset(new HistoryStore(path, rows, run, file));
        if (code != SQLITE_OK) return out.store->failed("history.open", "opened");
        sqlite3_extended_result_codes(file, 1);
        sqlite3_busy_timeout(file, patience_ms);
        const auto ready = out.store->prepare();
        if (ready) return out;
        if (!first || ready.error().code != "history.torn") return ready.error();
        out.store.reset();
        out.moved_aside = move_aside(path);
        if (out.moved_aside.empty()) return ready.error();
    }
    return out;
}

HistoryStore::~HistoryStore() {
    for (auto* statement : {insert_, update_, prune_, select_}) sqlite3_finalize(statement);
    sqlite3_close_v2(file_);
}

Error HistoryStore::failed(std::string code, std::string_view doing) const {
    const int number = file_ != nullptr ? sqlite3_extended_errcode(file_) : SQLITE_NOMEM;
    if (is_torn(number)) code = "history.torn";
    if ((number & 0xFF) == SQLITE_BUSY)
        return {"history.in_use", path_, "another process has the alarm history open",
                "End that process, or give this machine another folder: `history: {directory: ...}`."};
    return {std::move(code), path_,
            fmt::format("the alarm history cannot be {}: {}", doing, file_ != nullptr ? sqlite3_errmsg(file_) : "no memory"),
            "Make room on that disk and see that the folder may be written, or give another one: `history: {directory: ...}`."};
}

bool HistoryStore::execute(const std::string& sql) { return sqlite3_exec(file_, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK; }

Result<void> HistoryStore::prepare() {
    const Error torn{"history.torn", path_, "the file is torn, or no alarm history", "Look at the disk."};
    if (!execute(set_up)) return failed("history.open", "opened");
    std::string answer;
    if (!ask(file_, "PRAGMA user_version", answer)) return failed("history.open", "read");
    const bool fresh = answer == "0" && ask(file_, "SELECT count(*) FROM sqlite_schema", answer) && answer == "0";
    if (fresh && !execute(make_table)) return failed("history.open", "made");
    if (!fresh && (!ask(file_, "PRAGMA user_version", answer) || answer != std::to_string(version))) return torn;
    if (!ask(file_, "PRAGMA quick_check(1)", answer) || answer != "ok") return torn;
    if (run_ == 0) {
        if (!ask(file_, "SELECT coalesce(max(run), 0) + 1 FROM alarms", answer)) return torn;
        run_ = std::max<std::int64_t>(std::strtoll(answer.c_str(), nullptr, 10), 1);
        if (!execute(fmt::format("UPDATE alarms SET state={} WHERE state<{}", static_cast<int>(AlarmState::unknown),
                                 static_cast<int>(AlarmState::gone))))
            return failed("history.open", "written");
    }
    const std::array statements{std::pair{&insert_, insert_row}, std::pair{&update_, update_row}, std::pair{&prune_, prune_rows},
                                std::pair{&select_, select_rows}};
    for (const auto& [statement, sql] : statements)
        if (sqlite3_prepare_v3(file_, sql, -1, SQLITE_PREPARE_PERSISTENT, statement, nullptr) != SQLITE_OK) return torn;
    return {};
}

Result<void> HistoryStore::put(const AlarmWatch::Change& change) {
    for (auto* statement : {update_, insert_}) {
        bind_row(statement, change.row);
        sqlite3_bind_int64(statement, 16, run_);
        sqlite3_bind_int64(statement, 17, static_cast<std::int64_t>(change.key));
        const bool done = sqlite3_step(statement) == SQLITE_DONE;
        auto outcome = done ? Result<void>{} : failed("history.write", "written");
        sqlite3_reset(statement);
        if (!outcome || sqlite3_changes(file_) > 0) return outcome;
    }
    return {};
}

Result<void> HistoryStore::write(std::span<const AlarmWatch::Change> changes) {
    if (!execute("BEGIN IMMEDIATE")) return failed("history.write", "written");
    Result<void> outcome;
    for (const auto& change : changes)
        if (outcome) outcome = put(change);
    if (outcome) {
        sqlite3_bind_int64(prune_, 1, rows_);
        if (sqlite3_step(prune_) != SQLITE_DONE) outcome = failed("history.write", "written");
        sqlite3_reset(prune_);
    }
    if (outcome && !execute("COMMIT")) outcome = failed("history.write", "written");
    if (!outcome) execute("ROLLBACK");
    return outcome;
}

Result<HistoryPage> HistoryStore::read(const HistoryQuery& query) {
    if (query.text.find('\0') != std::string::npos) return HistoryPage{};  // LIKE would read only what stands before it
    const int limit = std::clamp(query.limit, 1, most_rows);
    sqlite3_bind_int64(select_, 1, query.before);
    sqlite3_bind_int64(select_, 2, query.since_utime);
    sqlite3_bind_int64(select_, 3, query.until_utime);
    bind_text(select_, 4, query.source);
    bind_text(select_, 5, anywhere(query.text));
    sqlite3_bind_int64(select_, 6, limit + 1);
    HistoryPage page;
    int code = SQLITE_DONE;
    while ((code = sqlite3_step(select_)) == SQLITE_ROW) {
        page.more = static_cast<int>(page.rows.size()) == limit;
        if (!page.more) page.rows.push_back(row_of(select_));
    }
    Result<HistoryPage> outcome = std::move(page);
    if (code != SQLITE_DONE) outcome = failed("history.read", "read");
    sqlite3_reset(select_);
    return outcome;
}

}  // namespace taktwerk::hmi
