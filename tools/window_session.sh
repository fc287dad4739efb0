#!/bin/bash
# window_session.sh WIDTH HEIGHT BLENDER [ARGUMENT]...   runs a Blender with a window of that size, on an X server of its
# own (Xvfb, software OpenGL) where there is one, else on the display that DISPLAY names. Its status is Blender's.
set -u
width=$1 height=$2
shift 2

if command -v Xvfb >/dev/null; then
    number=$(mktemp)
    Xvfb -displayfd 3 -screen 0 "${width}x${height}x24" +extension GLX +render -noreset -nolisten tcp \
        3>"$number" 2>/dev/null &
    server=$!
    trap 'kill $server 2>/dev/null; rm -f "$number"' EXIT
    for _ in $(seq 100); do
        [ -s "$number" ] && break
        sleep 0.1
    done
    DISPLAY=:$(cat "$number")
    export DISPLAY LIBGL_ALWAYS_SOFTWARE=1
    # A Wayland session would win over the display.
    unset WAYLAND_DISPLAY
fi

# Lines come out as they are written, so that Blender's own and Python's are in their order.
line_by_line=
command -v stdbuf >/dev/null && line_by_line="stdbuf -oL -eL"
blender=$1
shift
$line_by_line "$blender" --factory-startup --gpu-backend opengl --window-geometry 0 0 "$width" "$height" "$@"
