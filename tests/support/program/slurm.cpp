#include "tests/support/program/slurm.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

namespace impinge::test {

namespace {

namespace fs = std::filesystem;

// where a daemon is installed, "" if nowhere
std::string program(const std::string& name) {
  for (const char* folder : {"/usr/sbin/", "/usr/bin/", "/usr/local/sbin/", "/usr/local/bin/"})
    if (access((folder + name).c_str(), X_OK) == 0) return folder + name;
  return "";
}

int free_port() {
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (s < 0 || bind(s, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(s, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no free port");
  close(s);
  return ntohs(address.sin_port);
}

pid_t start(const std::string& path, const fs::path& log) {
  const pid_t parent = getpid(), pid = fork();
  if (pid != 0) return pid;
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // no daemon outlives a test that crashes
  if (getppid() != parent) _exit(1);
  const int out = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(out, STDOUT_FILENO);
  dup2(out, STDERR_FILENO);
  execl(path.c_str(), path.c_str(), "-D", nullptr);
  _exit(127);
}

void end(pid_t& pid) {
  if (pid <= 0) return;
  kill(pid, SIGTERM);
  for (int i = 0; i < 100; ++i) {
    if (waitpid(pid, nullptr, WNOHANG) != 0) {
      pid = -1;
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  pid = -1;
}

std::string said(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  for (int c = pipe == nullptr ? EOF : std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  if (pipe != nullptr) pclose(pipe);
  return text;
}

}  // namespace

SlurmCluster::SlurmCluster() {
  const std::string controller = program("slurmctld"), node = program("slurmd");
  if (controller.empty() || node.empty() || program("sbatch").empty()) {
    trouble_ = "slurmctld, slurmd and sbatch are not installed (.ci/setup checks installs them)";
    return;
  }
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const std::string name = std::string(host).substr(0, std::string(host).find('.')),
                    user = geteuid() == 0 ? "root" : said("id -un");
  const std::string at = folder_.path().string();
  fs::create_directories(folder_ / "state");
  fs::create_directories(folder_ / "spool");
  const fs::path conf = folder_.write(
      "slurm.conf",
      fmt::format("ClusterName=impinge\nSlurmctldHost={0}(127.0.0.1)\nSlurmctldPort={1}\nSlurmdPort={2}\nAuthType=auth/"
                  "none\nCredType=cred/none\nSlurmUser={3}\nSlurmdUser={3}\n"
                  "StateSaveLocation={4}/state\nSlurmdSpoolDir={4}/spool\nSlurmctldPidFile={4}/"
                  "slurmctld.pid\nSlurmdPidFile={4}/slurmd.pid\nSlurmctldLogFile={4}/slurmctld.log\n"
                  "SlurmdLogFile={4}/slurmd.log\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/"
                  "none\nJobAcctGatherType=jobacct_gather/none\n"
                  "AccountingStorageType=accounting_storage/none\nSelectType=select/"
                  "cons_tres\nSelectTypeParameters=CR_CPU\nSwitchType=switch/none\nMpiDefault=none\nReturnToService=2\n"
                  "SchedulerParameters=sched_interval=1,batch_sched_delay=0\nMinJobAge=2\nKillWait=5\nNodeName={0} "
                  "NodeAddr=127.0.0.1 CPUs={5} State=UNKNOWN\n"
                  "PartitionName=all Nodes={0} Default=YES MaxTime=INFINITE State=UP\n",
                  name, free_port(), free_port(), user.substr(0, user.find('\n')), at,
                  std::max(1u, std::thread::hardware_concurrency())));
  setenv("SLURM_CONF", conf.c_str(), 1);
  controller_ = start(controller, folder_ / "slurmctld.out");
  node_ = start(node, folder_ / "slurmd.out");
  for (int i = 0; i < 300; ++i) {
    if (said("sinfo --noheader --format=%t 2>/dev/null").rfind("idle", 0) == 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  trouble_ = "the node never took jobs: " + slurp(folder_ / "slurmctld.out") + slurp(folder_ / "slurmd.out");
}

void SlurmCluster::stop() { end(node_), end(controller_); }

SlurmCluster::~SlurmCluster() {
  stop();
  unsetenv("SLURM_CONF");
}

}  // namespace impinge::test
