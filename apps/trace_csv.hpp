#pragma once
// A trace as CSV: the first line names the columns, then one line a cycle. Numbers are written shortest and exact, so two equal
// runs give equal bytes.

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "runtime/snapshot.hpp"
#include "runtime/trace_ring.hpp"

namespace taktwerk::apps {

class TraceCsv {
public:
    /// `layout` gives the units of the axes: "x.set_position[mm]".
    static Result<std::unique_ptr<TraceCsv>> create(const std::string& path, runtime::TraceRing& ring,
                                                    const runtime::MachineLayout& layout);
    ~TraceCsv();

    /// Writes all rows that are waiting. Error trace.write, once: from then on rows are taken and lost.
    Result<void> drain();
    /// Flushes; an error of the disk shows here at the latest, and that of an earlier drain() again.
    [[nodiscard]] Result<void> finish();

private:
    TraceCsv(std::string path, std::FILE* file, runtime::TraceRing& ring) : path_(std::move(path)), file_(file), ring_(ring) {}
    [[nodiscard]] Error failure() const;
    std::string path_;
    std::FILE* file_;
    runtime::TraceRing& ring_;
    std::string line_;
    std::optional<Error> broken_;
};

}  // namespace taktwerk::apps
