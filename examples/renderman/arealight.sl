/* The area lights that `pelage rib` writes, for renderers whose lights are points: the whole light is at its
   centre. `from`, `axis` and `area` are parameters of the file; an axis of 0 shines everywhere. */
light arealight(float intensity = 1; color lightcolor = 1; point from = point "world" (0, 0, 0);
                vector axis = vector "world" (0, 0, 0); float area = 1; uniform string name = "", pelage = "";)
{
  illuminate(from) {
    float facing = 1;
    if (length(axis) > 0) facing = max(0, normalize(L).normalize(axis));
    Cl = intensity * lightcolor * area * facing / (L.L);
  }
}
