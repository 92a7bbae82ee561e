# SPDX-License-Identifier: BSD-3-Clause
# What the commands of this package share: find ROS, install what is missing, build. To be sourced by bash.
#   bq_set_up [--yes] GROUP...    groups of packages: build, demo, viewer, test, valgrind, benchmark, peers, checks
#   bq_configure [--with-tests] BUILD_DIR [CMAKE_OPTION...]
#     where nothing is configured; without --with-tests no test is, since the tests need packages of their own. A
#     configuration without tests gets them when they are wanted, and keeps what is built.
#   bq_build [--with-tests] BUILD_DIR TARGETS...    configures if need be, and builds
# All return 1 after a sentence on stderr that says what to do.

bq_source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# Somebody's own python3 before the system's has no ROS.
export PATH=/usr/bin:$PATH

# Prints the packages of a group, by the names of Debian's own ROS or of packages.ros.org.
bq_packages() {
  case $bq_ros/$1 in
    */build) echo build-essential cmake ninja-build libeigen3-dev libboost-dev libtbb-dev ;;&
    */test) echo libgmp-dev libgtest-dev ;;&
    */valgrind) echo valgrind ;;
    */benchmark) echo python3-matplotlib ;;
    */peers) echo libembree-dev libbullet-dev libfcl-dev libode-dev ;;
    debian/build) echo catkin libroscpp-dev libtf2-dev libtf2-ros-dev libtf2-msgs-dev libstd-msgs-dev \
      libgeometry-msgs-dev libvisualization-msgs-dev libnodelet-dev libnodeletlib-dev pluginlib-dev \
      libdiagnostic-msgs-dev libdiagnostic-updater-dev \
      libinteractive-markers-dev ros-std-msgs ros-geometry-msgs ros-visualization-msgs ros-message-generation ros-message-runtime ;;
    debian/demo) echo python3-roslaunch python3-rosservice python3-rospy python3-std-msgs \
      python3-geometry-msgs python3-visualization-msgs tf2-tools ;;
    debian/viewer) echo rviz ;;
    debian/test) echo librostest-dev python3-rosbag python3-rostest libnodeletlib-tools ;;
    debian/checks) echo catkin-lint clang clang-format clang-tidy cppcheck ;;
    noetic/build) echo ros-noetic-catkin ros-noetic-roscpp ros-noetic-tf2 ros-noetic-tf2-ros \
      ros-noetic-std-msgs ros-noetic-geometry-msgs ros-noetic-visualization-msgs \
      ros-noetic-message-generation ros-noetic-message-runtime ros-noetic-nodelet ros-noetic-pluginlib \
      ros-noetic-diagnostic-msgs ros-noetic-diagnostic-updater ros-noetic-interactive-markers ;;
    noetic/demo) echo ros-noetic-roslaunch ros-noetic-rosservice ros-noetic-rospy ;;
    noetic/viewer) echo ros-noetic-rviz ;;
    noetic/test) echo ros-noetic-rosbag ros-noetic-rostest ;;
    noetic/checks) echo python3-catkin-lint clang clang-format clang-tidy cppcheck ;;
  esac
}

bq_find_ros() {
  if [ -d /opt/ros/noetic ] || [ "$(. /etc/os-release && echo "$VERSION_CODENAME")" = focal ]; then
    bq_ros=noetic
  else
    bq_ros=debian
  fi
}

bq_missing_packages() {
  local package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

bq_install() {
  local yes=$1 command sudo='' answer package
  shift
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Packages are missing, and there is no sudo here to install them. Let root run" >&2
      echo "  apt-get update && apt-get install -y --no-install-recommends $*" >&2
      echo "and start this again." >&2
      return 1
    fi
    sudo='sudo '
  fi
  command="${sudo}apt-get install -y --no-install-recommends $*"
  echo "These packages are missing and will be installed:" >&2
  echo "  $command" >&2
  if [ "$yes" != yes ] && [ "${CI:-}" != true ]; then
    if [ ! -t 0 ]; then
      echo "Nobody can be asked here. Run that command, or this one again with --yes." >&2
      return 1
    fi
    read -r -p "Go on? [Y/n] " answer
    case $answer in
      '' | [Yy]*) ;;
      *) return 1 ;;
    esac
  fi
  # Package lists first where there are none, or none that knows the packages.
  for package in "$@"; do
    if ! apt-cache show "$package" >/dev/null 2>&1; then
      ${sudo}apt-get update -q || return 1
      break
    fi
  done
  for package in "$@"; do
    if ! apt-cache show "$package" >/dev/null 2>&1; then
      echo "apt knows no package $package. This needs ROS 1: Debian 12 has it; on Ubuntu 20.04 add the" \
        "package source as on http://wiki.ros.org/noetic/Installation/Ubuntu first." >&2
      return 1
    fi
  done
  ${sudo}env DEBIAN_FRONTEND=noninteractive ${command#"$sudo"}  # sudo itself would drop the variable
}

bq_set_up() {
  local yes=no group missing
  local -a packages=()
  if [ "${1:-}" = --yes ]; then
    yes=yes
    shift
  fi
  bq_find_ros
  for group in "$@"; do
    packages+=($(bq_packages "$group"))
  done
  missing=$(bq_missing_packages "${packages[@]}")
  if [ -n "$missing" ]; then
    bq_install $yes $missing || return 1
  fi
  if [ $bq_ros = noetic ]; then
    bq_source /opt/ros/noetic/setup.bash
  fi
}

# Set-up scripts of ROS read variables that are not set, and our arguments if they get none.
bq_source() {
  local flags=$-
  set +u
  . "$1" --
  case $flags in *u*) set -u ;; esac
}

# Runs a command with its output in a log: the last line shown on a terminal, all of it on failure.
bq_logged() {
  local log=$1 line status
  shift
  if [ "${bq_verbose:-no}" = yes ]; then
    "$@" 2>&1 | tee "$log" >&2
    status=${PIPESTATUS[0]}
  elif [ -t 2 ]; then
    "$@" 2>&1 | tee "$log" | while read -r line; do printf '\r\033[K%.78s' "$line" >&2; done
    status=${PIPESTATUS[0]}
    printf '\r\033[K' >&2
  else
    status=0
    "$@" >"$log" 2>&1 || status=$?
  fi
  if [ "$status" != 0 ]; then
    [ "${bq_verbose:-no}" = yes ] || grep -v 'Built target' "$log" >&2
    echo "That failed: $*" >&2
    echo "What it said is above and in $log" >&2
    return 1
  fi
}

# Whether tests are configured: they are not by the demo, nor where what they need was missing.
bq_has_tests() {
  [ -e "$1/tests.txt" ] && grep -qxF CATKIN_ENABLE_TESTING:BOOL=ON "$1/CMakeCache.txt"
}

bq_configure() {
  local build_dir tests=OFF cache
  if [ "$1" = --with-tests ]; then
    tests=ON
    shift
  fi
  build_dir=$1
  cache=$build_dir/CMakeCache.txt
  shift
  # A checkout that was moved or copied is built anew, and what make has built.
  if [ -e "$cache" ] &&
    ! { grep -qxF "CMAKE_CACHEFILE_DIR:INTERNAL=$build_dir" "$cache" &&
      grep -qxF 'CMAKE_GENERATOR:INTERNAL=Ninja' "$cache"; }; then
    rm -rf "$build_dir"
  fi
  mkdir -p "$build_dir" || return 1
  if [ ! -e "$build_dir/build.ninja" ] ||
    { [ $tests = ON ] && ! bq_has_tests "$build_dir"; }; then
    # roslaunch looks for files in the whole checkout, but for hidden folders: what is installed must not be found twice.
    echo "Configuring in $build_dir" >&2
    # A compiler launcher that keeps what was compiled, as ccache, would find nothing again.
    if [ $tests = ON ] && [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ]; then
      set -- -DBOX_QUERY_PRECOMPILE=ON "$@"
    fi
    bq_logged "$build_dir/configure.log" cmake -S "$bq_source_dir" -B "$build_dir" \
      -G Ninja -DPYTHON_EXECUTABLE=/usr/bin/python3 \
      -DCMAKE_INSTALL_PREFIX="$build_dir/.install" -DCATKIN_ENABLE_TESTING=$tests "$@" || return 1
  else  # again, if CMake's files have changed
    bq_logged "$build_dir/configure.log" cmake --build "$build_dir" --target build.ninja || return 1
  fi
}

bq_build() {
  local tests='' build_dir
  if [ "$1" = --with-tests ]; then
    tests=$1
    shift
  fi
  build_dir=$1
  shift
  bq_configure $tests "$build_dir" || return 1
  echo "Building in $build_dir" >&2
  # (make would build the targets one after the other.)
  bq_logged "$build_dir/build.log" cmake --build "$build_dir" --target "$@" \
    -- -j "$(nproc)" || return 1
  bq_source "$build_dir/devel/setup.bash"
}
