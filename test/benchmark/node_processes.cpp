// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/node_processes.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace box_query::benchmark {
namespace {

/// A socket of this host, by its port.
class Socket {
 public:
  explicit Socket(int port) : file_(socket(AF_INET, SOCK_STREAM, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address_.sin_port = htons(static_cast<std::uint16_t>(port));
  }
  ~Socket() { close(file_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  bool connects() { return connect(file_, any(), sizeof address_) == 0; }
  /// The port that it is bound to; 0: none.
  int bound() {
    socklen_t size = sizeof address_;
    const bool is_bound = bind(file_, any(), size) == 0 && getsockname(file_, any(), &size) == 0;
    return is_bound ? ntohs(address_.sin_port) : 0;
  }

 private:
  sockaddr* any() { return reinterpret_cast<sockaddr*>(&address_); }

  int file_;
  sockaddr_in address_{};
};

/// A port that nobody listens to: the kernel chooses it.
int freePort() {
  const int port = Socket(0).bound();
  if (port == 0) {
    throw std::runtime_error("no port is free for a ROS master");
  }
  return port;
}

}  // namespace

Process::Process(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // whatever ends us
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  if (pid_ < 0) {
    throw std::runtime_error(arguments[0] + " cannot be started: " + std::strerror(errno));
  }
}

Process::~Process() {
  kill(pid_, SIGTERM);
  waitpid(pid_, nullptr, 0);
}

Master::Home::Home()
    : path_((std::filesystem::temp_directory_path() / "box_query_benchmark.XXXXXX").string()) {
  if (mkdtemp(path_.data()) == nullptr) {
    throw std::runtime_error("no directory " + path_ + " can be made");
  }
  setenv("ROS_HOME", path_.c_str(), 1);
  unsetenv("ROS_LOG_DIR");
}

Master::Home::~Home() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Master::Master()
    : port_(freePort()), process_({"rosmaster", "--core", "--port", std::to_string(port_)}) {
  setenv("ROS_MASTER_URI", ("http://127.0.0.1:" + std::to_string(port_)).c_str(), 1);
  setenv("ROS_IP", "127.0.0.1", 1);
  unsetenv("ROS_HOSTNAME");
  unsetenv("ROS_NAMESPACE");
  for (int i = 0; !Socket(port_).connects(); ++i) {
    if (i == 3000) {
      throw std::runtime_error("no ROS master starts: is rosmaster in PATH?");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace box_query::benchmark
