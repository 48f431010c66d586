"""Renderers as clients: each renders scenes that `trueflight export` wrote, and has its pixels judged."""
