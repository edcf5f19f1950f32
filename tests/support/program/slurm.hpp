// A whole Slurm cluster on this machine for the life of a test: one slurmctld, one slurmd, no munge, ports that were
// free.
#pragma once

#include <sys/types.h>

#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

class SlurmCluster {
 public:
  /// Starts the daemons and waits until the node takes jobs; SLURM_CONF then names this cluster for all children.
  SlurmCluster();
  /// Ends both daemons, whatever has happened.
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// "" when it runs; else why it can't: the daemons are not installed, or what they said.
  const std::string& trouble() const { return trouble_; }

 private:
  void stop();
  TempFolder folder_;
  pid_t controller_ = -1, node_ = -1;
  std::string trouble_;
};

}  // namespace impinge::test
