#pragma once
// Problems on standard error: what, where, why, what to do.

#include <vector>

#include "core/result.hpp"

namespace taktwerk::apps {

/// One block a problem.
void print_errors(const std::vector<Error>& errors);
void print_error(const Error& error);
void print_warning(const Error& warning);

}  // namespace taktwerk::apps
