// The one place where threads are used. Results never depend on the number of threads: every index writes its own slot,
// and whoever merges does so in index order.
#pragma once

#include <cstddef>
#include <functional>

namespace impinge {

/// Sets how many threads parallel_for may use; 0 = as many as the machine has cores.
void set_thread_count(int count);
int thread_count();

/// Calls body(i) for 0 <= i < count, `grain` indices at least a task. Runs in the caller when one task is enough. Looks
/// at the caller's interrupt flag before each index (interrupt.hpp); what body throws arrives at the caller.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body);

}  // namespace impinge
