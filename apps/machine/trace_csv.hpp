#pragma once
// A trace as CSV: the first line names the columns, then one line a cycle. Numbers are written shortest and exact, so two equal
// runs give equal bytes.

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "runtime/recording/row_cursor.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::apps {

class TraceCsv {
public:
    /// `layout` gives the units of the axes: "x.set_position[mm]".
    static Result<std::unique_ptr<TraceCsv>> create(const std::string& path, runtime::SignalRing& ring,
                                                    const runtime::MachineLayout& layout);
    ~TraceCsv();

    /// Before the first drain(): the instant of the machine's time that the column time_s calls 0, which is that of the log.
    void count_from(Instant start) noexcept { start_s_ = to_seconds(start.time_since_epoch()); }
    /// Writes all rows that are waiting. Error trace.write, once: from then on rows are taken and lost.
    Result<void> drain();
    /// Flushes; an error of the disk shows here at the latest, and that of an earlier drain() again.
    [[nodiscard]] Result<void> finish();

private:
    TraceCsv(std::string path, std::FILE* file, runtime::SignalRing& ring);
    [[nodiscard]] Error failure() const;
    std::string path_;
    std::FILE* file_;
    runtime::RowCursor rows_;
    std::vector<runtime::SignalCell> columns_;
    std::string line_;
    std::optional<Error> broken_;
    double start_s_ = 0;
};

}  // namespace taktwerk::apps
