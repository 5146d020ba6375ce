/* Fur in the shading language of the RenderMan Interface 3.2: light along and across a thin fibre after Kajiya
   and Kay (1989), with the colour of the strands. A stand-in for the fibre models of Pelage, which need rays
   within the coat: the coat shadows itself only as far as the lights of the renderer have shadows. */
surface pelage_fur(float diffuse = 0.8, specular = 0.25, roughness = 0.12; uniform string name = "", model = "", pelage = "";)
{
  vector T = normalize(dPdv); /* along the strand */
  vector V = -normalize(I);
  color scattered = 0, reflected = 0;
  illuminance(P) {
    vector LN = normalize(L);
    /* Without shadows: the coat that the camera sees is in the shadow of lights behind it. */
    float open = smoothstep(-0.4, 0.6, LN.V);
    float along = T.LN, across = sqrt(max(0, 1 - along * along));
    float view_along = T.V, view_across = sqrt(max(0, 1 - view_along * view_along));
    scattered += open * Cl * across;
    reflected += open * Cl * pow(max(0, across * view_across - along * view_along), 1 / roughness);
  }
  Oi = Os;
  Ci = Os * (Cs * (diffuse * scattered / PI + ambient()) + specular * reflected / PI);
}
