#pragma once

#include <string>
#include <vector>

namespace bodeflow::test {

/// The processes of the built command whose command lines have all these words.
std::vector<int> processes_with(const std::vector<std::string>& words);

/// Memory that a process has in place, in MB; 0: it is not there any more.
double resident_mb(int process);

/// The segments of shared memory that a process has open.
std::vector<std::string> shared_memory_of(int process);

/// From now on each UDP socket that the process has open loses that share of what comes, by chance (a filter in the kernel).
/// Returns how many sockets that are.
int lose(int process, double share);

}  // namespace bodeflow::test
