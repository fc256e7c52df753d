# Sourced by the other scripts: a clean ROS environment around the build folder in $build.
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build="${SPELUNK_BUILD_DIR:-$root/build}"
if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  . /opt/ros/noetic/setup.bash
  set -u
else
  unset PYTHONPATH PYTHONHOME CMAKE_PREFIX_PATH ROS_PACKAGE_PATH LD_LIBRARY_PATH
fi
export PATH=/usr/bin:/bin:$PATH  # another python3 first on the PATH lacks rospy
unset ROS_HOSTNAME ROS_MASTER_URI
export ROS_IP=127.0.0.1 ROS_HOME="$build/ros_home"
export ROSCONSOLE_STDOUT_LINE_BUFFERED=1 PYTHONUNBUFFERED=1
grep -q '127.0.0.1' /etc/hosts 2>/dev/null || echo "127.0.0.1 localhost" >>/etc/hosts || \
  echo "warning: /etc/hosts does not name localhost; ROS needs that" >&2

# Jobs that fit the memory: the largest translation units take about 1.5 GB.
jobs() {
  local by_memory=$(( $(awk '/MemAvailable/ {print $2}' /proc/meminfo) / 1600000 ))
  local by_cores=$(nproc)
  echo $(( by_memory < 1 ? 1 : by_memory < by_cores ? by_memory : by_cores ))
}
